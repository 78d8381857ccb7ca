#include "exitance/cli/summary.hpp"

#include <gtest/gtest.h>

namespace exitance {
namespace {

TEST(Summary, TellsTheTimeOfEveryPhaseThatTookAny) {
    SolveStatistics s;
    s.seconds = {{"total", 45}, {"read", 1},    {"mesh", 0},        {"direct", 3},       {"link", 4}, {"solve", 5},
                 {"gather", 6}, {"certify", 7}, {"reconstruct", 8}, {"light_groups", 9}, {"write", 2}};
    EXPECT_NE(summary(s).find("45 s (read 1, direct 3, link 4, solve 5, gather 6, certify 7, reconstruct 8, "
                              "light_groups 9, write 2)"),
              std::string::npos);
}

}  // namespace
}  // namespace exitance
