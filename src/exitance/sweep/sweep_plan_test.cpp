#include "exitance/sweep/sweep_plan.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "support/temporary_folder.hpp"

namespace exitance {
namespace {

const std::string step = "[[step]]\nrun = \"check {scene}\"\n";
const std::string scene = "[scene]\ngenerate = \"complex m={m}\"\n";

/// The variants of a plan, "m=1 rho=0.5", one per line.
std::string variants_of(const std::string& vary) {
    const Result<SweepPlan> plan = parse_sweep_plan(vary + step, "plan.toml");
    if (!plan) return plan.error().where + ": " + plan.error().message;
    std::string out;
    for (const SweepSetting& variant : plan->variants) {
        std::string line;
        for (const auto& [name, value] : variant) line += (line.empty() ? "" : " ") + name + "=" + text_of(value);
        out += line + "\n";
    }
    return out;
}

/// The place and the message of the error in a plan.
std::string error_of(const std::string& text) {
    const Result<SweepPlan> plan = parse_sweep_plan(text, "plan.toml");
    return plan ? "" : plan.error().where + ": " + plan.error().message;
}

}  // namespace

TEST(SweepPlan, BlocksAndTheirListsAreCrossedAndTheLastParameterChangesFirst) {
    EXPECT_EQ(variants_of("[[vary]]\nz = [1, 2]\na = [\"x y\", true]\n[[vary]]\nb = 0.5\n"),
              "z=1 a=x y b=0.5\nz=1 a=true b=0.5\nz=2 a=x y b=0.5\nz=2 a=true b=0.5\n");
}

TEST(SweepPlan, ListsOfABlockAreZippedIfItSaysSo) {
    EXPECT_EQ(variants_of("[[vary]]\ncombine = \"zip\"\na = [1, 2]\nb = [3, 4]\n[[vary]]\nc = [5, 6]\n"),
              "a=1 b=3 c=5\na=1 b=3 c=6\na=2 b=4 c=5\na=2 b=4 c=6\n");
}

TEST(SweepPlan, RowsListVariantsInAnyOrderOfTheirParameters) {
    EXPECT_EQ(variants_of("[[vary]]\nrows = [{ a = 1, b = 2 }, { b = 4, a = 3 }]\n"), "a=1 b=2\na=3 b=4\n");
}

TEST(SweepPlan, RangesHaveAStepOrACountAndNoRoundingErrors) {
    EXPECT_EQ(variants_of("[[vary]]\na = { from = 0, to = 0.3, step = 0.1 }\n"), "a=0\na=0.1\na=0.2\na=0.3\n");
    EXPECT_EQ(variants_of("[[vary]]\na = { from = 1, to = 0, count = 3 }\n"), "a=1\na=0.5\na=0\n");
    EXPECT_EQ(variants_of("[[vary]]\na = { from = 0, to = 1, step = 0.4 }\n"), "a=0\na=0.4\na=0.8\n");
}

TEST(SweepPlan, TablesAndFilesAreRead) {
    const TemporaryFolder folder;
    std::ofstream(folder / "rows.csv") << "sky,turn\n\"cie,clear\",30\novercast,60\n";
    for (const char* name : {"b.obj", "a.obj"}) std::ofstream(folder / name) << "";
    const Result<SweepPlan> plan =
        parse_sweep_plan("[scene]\nfiles = \"*.obj\"\n[[vary]]\ntable = \"rows.csv\"\n" + step, folder / "plan.toml");
    ASSERT_TRUE(plan) << plan.error().message;
    ASSERT_EQ(plan->variants.size(), 4u);
    EXPECT_EQ(plan->parameters, (std::vector<std::string>{"scene", "sky", "turn"}));
    EXPECT_EQ(plan->variants[0], (SweepSetting{{"scene", {"a.obj"}}, {"sky", {"cie,clear"}}, {"turn", {"30"}}}));
    EXPECT_EQ(plan->variants[3], (SweepSetting{{"scene", {"b.obj"}}, {"sky", {"overcast"}}, {"turn", {"60"}}}));
}

TEST(SweepPlan, PlaceholdersKeepWordsTogetherAndListsBecomeSeveralWords) {
    const Result<SweepPlan> plan = parse_sweep_plan(
        "[[vary]]\nsky = \"sun, high\"\nmore = [[\"--method\", \"matrix\"], []]\n[[step]]\nrun = 'solve a.obj --sky "
        "{sky} {more} -o {dir}/a.h5'\n",
        "plan.toml");
    ASSERT_TRUE(plan) << plan.error().message;
    const auto filled = [&](std::size_t i) { return *fill_in(*plan, plan->steps[0].words, plan->variants[i], 1); };
    EXPECT_EQ(filled(0), (std::vector<std::string>{"solve", "a.obj", "--sky", "sun, high", "--method", "matrix", "-o",
                                                   "{dir}/a.h5"}));
    EXPECT_EQ(filled(1), (std::vector<std::string>{"solve", "a.obj", "--sky", "sun, high", "-o", "{dir}/a.h5"}));
}

TEST(SweepPlan, ErrorsNameTheLineAndTheKey) {
    EXPECT_EQ(error_of("titel = \"x\"\n" + step), "plan.toml:1: 'titel' is not known here");
    EXPECT_EQ(error_of(step + "[[step]]\nname = \"b\"\n"), "plan.toml:3: 'run' is missing");
    EXPECT_EQ(error_of(step + "acept = [0]\n"), "plan.toml:3: 'acept' is not known here");
    EXPECT_EQ(error_of("[[vary]]\n\na = { from = 0, to = 1 }\n" + step),
              "plan.toml:3: the range 'a' has either 'step' or 'count'");
    EXPECT_EQ(error_of("[[vary]]\na = []\n" + step), "plan.toml:2: 'a' has no values");
    EXPECT_EQ(error_of("[[vary]]\ncombine = \"zip\"\na = [1, 2]\nb = [3]\n" + step),
              "plan.toml:4: 'b' has 1 values where the lists before have 2");
    EXPECT_EQ(error_of("[[vary]]\na = 1\n[[vary]]\na = 2\n" + step), "plan.toml:3: the parameter 'a' is given twice");
    EXPECT_EQ(error_of("[[vary]]\ndir = 1\n" + step), "plan.toml:2: 'dir' cannot be a parameter");
    EXPECT_EQ(error_of("[[vary]]\na = 1979-05-27\n" + step),
              "plan.toml:2: 'a' has a value that is neither text, a number, true nor false");
    EXPECT_EQ(error_of("[scene]\ngenerate = \"complex\"\ntemplate = \"a.obj\"\n" + step),
              "plan.toml:1: a scene has one of 'generate', 'template' and 'files'");
    EXPECT_EQ(error_of("[scene]\nfiles = \"/nowhere/*.obj\"\n" + step), "plan.toml:2: there is no file /nowhere/*.obj");
    EXPECT_EQ(error_of(step + step), "plan.toml:3: two steps are called 'check'");
    EXPECT_EQ(error_of(step + "[[output]]\nname = \"e\"\nstep = \"solve\"\njson = \"e\"\n"),
              "plan.toml:5: there is no step 'solve'");
    EXPECT_EQ(error_of(step + "[[output]]\nname = \"e\"\nstep = \"check\"\njson = \"e\"\n"),
              "plan.toml:5: the step 'check' prints no JSON");
    EXPECT_EQ(error_of(step + "[[output]]\nname = \"e\"\nfile = \"e.csv\"\ncolumn = \"e\"\ntake = \"median\"\n"),
              "plan.toml:7: 'median' is not one of value, mean, sum, min, max, all");
    EXPECT_EQ(error_of("title = \"x\n"), error_of("title = \"x\n"));
    EXPECT_EQ(error_of("title = \"x\n").substr(0, 12), "plan.toml:1:");
    EXPECT_EQ(error_of(""), "plan.toml:1: a plan has a [[step]] at least");
}

}  // namespace exitance
