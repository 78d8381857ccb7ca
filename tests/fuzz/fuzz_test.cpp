#include <gtest/gtest.h>

#include <cstdlib>
#include <ostream>

#include "exitance/base/sanitizers.hpp"
#include "fuzz/mutator.hpp"
#include "fuzz/target.hpp"

namespace exitance::fuzz {

void PrintTo(const Target& target, std::ostream* out) {
    *out << target.name;
}

namespace {

constexpr std::uint64_t default_rounds =
    has_address_sanitizer ? 100 : 400;  // files take ten times as long with the sanitizer

/// Number of damaged files per reader; the environment variable EXITANCE_FUZZ_ROUNDS overrides it.
std::uint64_t rounds() {
    const char* asked = std::getenv("EXITANCE_FUZZ_ROUNDS");
    return asked ? std::strtoull(asked, nullptr, 10) : default_rounds;
}

class Readers : public testing::TestWithParam<Target> {};

}  // namespace

TEST_P(Readers, SurviveDamagedFiles) {
    const Target& target = GetParam();
    const std::vector<std::string> corpus = target.corpus();
    ASSERT_FALSE(corpus.empty());
    for (const std::string& whole : corpus) target.read(whole);
    const Mutator mutator(corpus, 1);
    for (std::uint64_t round = 0; round < rounds(); ++round) {
        std::string bytes = mutator.make(round);
        if (target.mend && round % 2 == 0) target.mend(bytes);
        target.read(bytes);
    }
}

INSTANTIATE_TEST_SUITE_P(Fuzz, Readers, testing::ValuesIn(targets().begin(), targets().end()),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(FuzzMutator, TheSameSeedGivesTheSameDamage) {
    const std::vector<std::string> corpus = {"v 1 2 3\nf 1 2 3\n", "newmtl a\nKd 1 2 3\n"};
    const Mutator a(corpus, 7), b(corpus, 7), c(corpus, 8);
    std::size_t same = 0, changed = 0;
    for (std::uint64_t round = 0; round < 100; ++round) {
        EXPECT_EQ(a.make(round), b.make(round));
        same += a.make(round) == c.make(round);
        changed += a.make(round) != corpus[0] && a.make(round) != corpus[1];
    }
    EXPECT_LT(same, 10u);
    EXPECT_GT(changed, 80u);
}

}  // namespace exitance::fuzz
