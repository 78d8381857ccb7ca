#include <gtest/gtest.h>

#include "exitance/methods/solve_scene.hpp"
#include "support/all_states.hpp"
#include "support/built_scene.hpp"

namespace exitance {
namespace {

void expect_same(const ElementFunction& a, const ElementFunction& b) {
    ASSERT_EQ(a.tree.size(), b.tree.size());
    EXPECT_EQ(a.values, b.values);
    for (ElementId e : a.tree.ids()) {
        ASSERT_EQ(a.tree.parent(e), b.tree.parent(e));
        ASSERT_EQ(a.tree.area(e), b.tree.area(e));
    }
}

void expect_same(const Solution& a, const Solution& b) {
    expect_same(a.indirect, b.indirect);
    expect_same(a.interpolant, b.interpolant);
    for (std::size_t band = 0; band < bands; ++band) EXPECT_EQ(a.direct_share[band], b.direct_share[band]);
    EXPECT_EQ(a.statistics.relative_error_estimate, b.statistics.relative_error_estimate);
    EXPECT_EQ(a.statistics.rays, b.statistics.rays) << "nothing is counted twice";
}

Solution solved_with_store(const Scene& scene, const SolveOptions& options, CheckpointStore* store) {
    Progress progress;
    const StopRequest stop;
    Result<Solution> solution = solve_scene(scene, options, progress, stop, store);
    EXI_CHECK(static_cast<bool>(solution));
    return std::move(*solution);
}

/// Requests a stop after `count` steps of progress.
class StopsAfter final : public Progress {
  public:
    StopsAfter(int count, StopRequest& stop) : left_(count), stop_(stop) {}
    void phase(std::string_view) override { step(); }
    void advance(double, std::string_view) override { step(); }

  private:
    void step() {
        if (left_-- == 0) stop_.interrupt();
    }
    int left_;
    StopRequest& stop_;
};

struct Case {
    Method method;
    double error;
};
class Checkpoints : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Methods, Checkpoints,
                         testing::Values(Case{Method::matrix, 0.012}, Case{Method::progressive, 0.05},
                                         Case{Method::substructuring, 0.05}, Case{Method::monte_carlo, 0.05},
                                         Case{Method::hierarchical, 0.04}, Case{Method::wavelet, 0.04}));

}  // namespace

TEST_P(Checkpoints, EverySavedStateLeadsToTheSameBits) {
    const Scene scene = built_scene("gcr2");
    const SolveOptions options{.method = GetParam().method, .error = GetParam().error};
    const Solution whole = solved_with_store(scene, options, nullptr);
    AllStates on_the_way;
    expect_same(solved_with_store(scene, options, &on_the_way), whole);
    const std::size_t count = on_the_way.states.size();
    ASSERT_GE(count, 4u);
    for (std::size_t i = 0; i < 5; ++i) {
        SCOPED_TRACE("state " + std::to_string(i * (count - 1) / 4) + " of " + std::to_string(count));
        AllStates resumed(on_the_way.states[i * (count - 1) / 4]);
        expect_same(solved_with_store(scene, options, &resumed), whole);
    }
}

TEST(Checkpoint, AStateSavedBeforeAnInterruptLeadsToTheSameBits) {
    const Scene scene = built_scene("gcr2");
    const SolveOptions options{.method = Method::matrix, .error = 0.012};
    const Solution whole = solved_with_store(scene, options, nullptr);
    for (int steps : {2, 5, 8}) {
        StopRequest stop;
        StopsAfter progress(steps, stop);
        AllStates kept;
        const Result<Solution> half = solve_scene(scene, options, progress, stop, &kept);
        ASSERT_TRUE(half);
        AllStates resumed(kept.states.empty() ? std::string() : kept.states.back());
        expect_same(solved_with_store(scene, options, &resumed), whole);
    }
}

TEST(Checkpoint, EverySavedStateOfARefiningAttemptLeadsToTheSameBits) {
    const Scene scene = built_scene("cornell");
    SolveOptions options{.error = 0.03};
    options.mesh_size = 3;  // elements as large as walls, so that the method's error dominates
    const Solution whole = solved_with_store(scene, options, nullptr);
    ASSERT_EQ(whole.statistics.refinement_steps, 1u);
    AllStates on_the_way;
    expect_same(solved_with_store(scene, options, &on_the_way), whole);
    const std::size_t count = on_the_way.states.size();
    for (std::size_t i = 0; i < count; i += std::max<std::size_t>(1, count / 16)) {
        SCOPED_TRACE("state " + std::to_string(i) + " of " + std::to_string(count));
        AllStates resumed(on_the_way.states[i]);
        expect_same(solved_with_store(scene, options, &resumed), whole);
    }
}

TEST(Checkpoint, AnInterruptedDiscontinuityMeshIsResumed) {
    /// Requests a stop after a number of states have been saved.
    class StopsAfterStates final : public CheckpointStore {
      public:
        StopsAfterStates(std::size_t count, StopRequest& stop) : left_(count), stop_(stop) {}
        bool is_due() const override { return true; }
        void keep(std::string state) override {
            last = std::move(state);
            if (--left_ == 0) stop_.interrupt();
        }
        std::string resumed() override { return {}; }
        std::string last;

      private:
        std::size_t left_;
        StopRequest& stop_;
    };
    const Scene scene = built_scene("table");
    const SolveOptions options{.method = Method::discontinuity, .bounces = 0, .error_interpolant = 0.01};
    const Solution whole = solved_with_store(scene, options, nullptr);
    for (const std::size_t states : {2, 3, 4}) {  // curves, first nodes, nodes of a round of bisection
        StopRequest stop;
        Progress progress;
        StopsAfterStates store(states, stop);
        ASSERT_TRUE(solve_scene(scene, options, progress, stop, &store));
        ASSERT_TRUE(stop.requested());
        AllStates resumed(store.last);
        const Solution again = solved_with_store(scene, options, &resumed);
        expect_same(again, whole);
        EXPECT_EQ(again.discontinuity.values, whole.discontinuity.values);
        EXPECT_EQ(again.discontinuity.nodes, whole.discontinuity.nodes);
        EXPECT_EQ(again.discontinuity.curves.size(), whole.discontinuity.curves.size());
        EXPECT_EQ(again.statistics.figures.at("resumed_receivers"), static_cast<double>(scene.regions().size()));
        EXPECT_EQ(again.statistics.figures.at("resumed_nodes") > 0, states > 2);
    }
}

}  // namespace exitance
