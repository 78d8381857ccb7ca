#include "exitance/sweep/plan_warnings.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "support/temporary_folder.hpp"

namespace exitance {
namespace {

/// Warnings of a plan whose template is `scene`.
std::vector<std::string> warnings_of(const std::string& text, const std::string& scene = "") {
    const TemporaryFolder folder;
    std::ofstream(folder / "a.obj") << scene;
    Result<SweepPlan> plan = parse_sweep_plan(text, folder / "p");
    if (!plan) return {plan.error().message};
    plan->path = "p";
    const Result<std::vector<std::string>> warnings = plan_warnings(*plan);
    EXPECT_TRUE(warnings);
    return warnings ? *warnings : std::vector<std::string>();
}

using Texts = std::vector<std::string>;

}  // namespace

TEST(PlanWarnings, ParametersThatNothingUsesAreNamed) {
    const std::string plan =
        "[scene]\ntemplate = \"a.obj\"\n[[vary]]\na = 1\nb = 1\nc = 1\nd = 1\n[[step]]\nrun = \"check {scene} x={b}\"\n"
        "inputs = [\"a.obj{ c }\"]\n";
    EXPECT_EQ(warnings_of(plan, "v {{ a }}\n"),
              (Texts{"p: no command and no template uses the parameter 'd', so it changes nothing"}));
    EXPECT_EQ(warnings_of(plan, "v {{a}} {{d}}\n"), Texts());
    EXPECT_EQ(warnings_of("[scene]\nfiles = \"a.obj\"\n[[step]]\nrun = \"check {scene}\"\n"), Texts());
}

TEST(PlanWarnings, VariantsWithEqualParametersAreNamed) {
    const std::string step = "[[step]]\nrun = \"check a{a}{b}\"\n";
    EXPECT_EQ(warnings_of("[[vary]]\na = [1, 2]\nb = [1, 2]\n" + step), Texts());
    EXPECT_EQ(warnings_of("[[vary]]\na = [3, 1, 3]\nb = 1\n" + step),
              (Texts{"p: variants 1 and 3 have equal parameters"}));
    EXPECT_EQ(warnings_of("[[vary]]\na = [2, 1, 1.0, 2]\nb = 1\n" + step),
              (Texts{"p: 2 variants have the parameters of an earlier one, such as 2 and 3"}));
}

}  // namespace exitance
