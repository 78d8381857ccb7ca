#include "exitance/discontinuity/node_values.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <numeric>

namespace exitance {
namespace {

constexpr std::uint32_t count = 10'000;  // more than one batch between checkpoints

std::vector<std::uint32_t> numbers(std::uint32_t first, std::uint32_t last) {
    std::vector<std::uint32_t> out(last - first);
    std::iota(out.begin(), out.end(), first);
    return out;
}

/// Light that counts its evaluations.
struct Lamp {
    std::atomic<std::size_t> looks = 0;
    NodeValues::Look look = [this](std::uint32_t n, WeakLight::Workspace&) {
        ++looks;
        return Spectrum(1.0 + n);
    };
};

TEST(NodeValues, NodesAreEvaluatedOnce) {
    Lamp lamp;
    NodeValues values;
    StopRequest stop;
    ASSERT_TRUE(values.look_at({7, 3, 7}, lamp.look, stop, [] {}));
    ASSERT_TRUE(values.look_at({3, 4}, lamp.look, stop, [] {}));
    EXPECT_EQ(lamp.looks, 3u);
    EXPECT_TRUE(values.has(4) && values.has(7));
    EXPECT_FALSE(values.has(5));
    EXPECT_EQ(values.values()[7], Spectrum(8.0));
}

TEST(NodeValues, ResumedValuesAreNotEvaluatedAgain) {
    StopRequest stop;
    std::vector<std::vector<Spectrum>> states;
    NodeValues whole;
    Lamp lamp;
    const auto fill = [&](NodeValues& values, Lamp& by, const std::function<void()>& keep) {
        return values.look_at(numbers(5'000, count), by.look, stop, keep) &&
               values.look_at(numbers(0, 5'000), by.look, stop, keep);
    };
    ASSERT_TRUE(fill(whole, lamp, [&] { states.push_back(whole.in_order()); }));
    ASSERT_GT(states.size(), 2u);
    for (const std::vector<Spectrum>& state : states) {
        NodeValues again;
        Lamp rest;
        again.resume(state);
        EXPECT_EQ(again.in_order(), state);  // the state is complete even if saved before any node is requested
        ASSERT_TRUE(fill(again, rest, [] {}));
        EXPECT_EQ(rest.looks, count - state.size());
        EXPECT_TRUE(std::equal(again.values().begin(), again.values().end(), whole.values().begin()));
    }
}

TEST(NodeValues, AfterAStopTheNodesOfTheBatchHaveNoLight) {
    StopRequest stop;
    NodeValues values;
    Lamp lamp;
    ASSERT_TRUE(values.look_at({1}, lamp.look, stop, [] {}));
    stop.interrupt();
    EXPECT_FALSE(values.look_at({1, 2}, lamp.look, stop, [] {}));
    EXPECT_TRUE(values.has(1));
    EXPECT_FALSE(values.has(2));
}

}  // namespace
}  // namespace exitance
