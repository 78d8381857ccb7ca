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
std::string plan_error(const std::string& text) {
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

TEST(SweepPlan, PlaceholdersMayHaveBlanks) {
    const Result<SweepPlan> plan = parse_sweep_plan(
        "[[vary]]\nm = [1, 2]\n[[step]]\nrun = \"solve a{ m }.obj -o '{ dir }/a b.h5' {no name}\"\ninputs = [\"{ m "
        "}.bin\"]\n",
        "plan.toml");
    ASSERT_TRUE(plan) << plan.error().message;
    EXPECT_EQ(plan->steps[0].words,
              (std::vector<std::string>{"solve", "a{m}.obj", "-o", "{dir}/a b.h5", "{no", "name}"}));
    EXPECT_EQ(plan->steps[0].inputs, (std::vector<std::string>{"{m}.bin"}));
}

TEST(SweepPlan, QuotesThatAreNotClosedAreErrors) {
    EXPECT_EQ(plan_error("[[step]]\nrun = \"check 'a.obj\"\n"),
              "plan.toml:2: the command has a quote ' that is not closed");
    EXPECT_EQ(plan_error("[scene]\ngenerate = 'office \"nx=1'\n" + step),
              "plan.toml:2: the command has a quote \" that is not closed");
    EXPECT_EQ(plan_error("[[step]]\nrun = \"check \\\"it's.obj\\\"\"\n"), "");
}

TEST(SweepPlan, SingleTablesInPlaceOfListsAreErrorsThatNameTheBrackets) {
    EXPECT_EQ(plan_error("[step]\nrun = \"check a.obj\"\n"),
              "plan.toml:1: 'step' is a list of tables, so [step] must be [[step]]");
    EXPECT_EQ(plan_error("[vary]\na = 1\n" + step),
              "plan.toml:1: 'vary' is a list of tables, so [vary] must be [[vary]]");
    EXPECT_EQ(plan_error(step + "[output]\nname = \"e\"\n"),
              "plan.toml:3: 'output' is a list of tables, so [output] must be [[output]]");
    EXPECT_EQ(plan_error("[[scene]]\nfiles = \"a.obj\"\n" + step), "plan.toml:1: 'scene' is not a table");
    const Result<SweepPlan> repeated = parse_sweep_plan("[step]\nrun = \"check\"\n[step]\nrun = \"check\"\n", "p");
    ASSERT_FALSE(repeated);
    EXPECT_EQ(repeated.error().hint, "a plan may have several such tables: write each as [[step]], not as [step]");
    const Result<SweepPlan> mixed = parse_sweep_plan("[step]\nrun = \"check\"\n[[step]]\nrun = \"check\"\n", "p");
    ASSERT_FALSE(mixed);
    EXPECT_EQ(mixed.error().hint, repeated.error().hint);
}

TEST(SweepPlan, TablesMayEndInBlankLinesAndHaveEachColumnOnce) {
    const TemporaryFolder folder;
    const std::string text = "[[vary]]\ntable = \"rows.csv\"\n" + step;
    std::ofstream(folder / "rows.csv") << "\xef\xbb\xbfwall,lamp\r\n0.2,1\r\n\r\n";
    const Result<SweepPlan> plan = parse_sweep_plan(text, folder / "plan.toml");
    ASSERT_TRUE(plan) << plan.error().message;
    EXPECT_EQ(plan->variants, (std::vector<SweepSetting>{{{"wall", {"0.2"}}, {"lamp", {"1"}}}}));
    std::ofstream(folder / "rows.csv") << "wall,lamp,wall\n0.2,1,0.3\n";
    const Result<SweepPlan> twice = parse_sweep_plan(text, folder / "plan.toml");
    ASSERT_FALSE(twice);
    EXPECT_EQ(twice.error().message, "the table rows.csv has 2 columns 'wall'");
}

TEST(SweepPlan, NamesOfFoldersAreShortEnoughForFileSystems) {
    const Result<SweepPlan> plan = parse_sweep_plan(step, std::string(250, 'n') + ".toml");
    ASSERT_FALSE(plan);
    EXPECT_EQ(plan.error().message.find("the name of the folder of the results has 256 bytes, and 255 are possible"),
              0u);
    EXPECT_NE(plan.error().hint.find("'folder'"), std::string::npos);
    EXPECT_TRUE(parse_sweep_plan("folder = \"short\"\n" + step, std::string(250, 'n') + ".toml"));
}

TEST(SweepPlan, ColumnsOfResultsHaveDifferentNames) {
    const auto output = [](const std::string& name, const std::string& take) {
        return "[[output]]\nname = \"" + name + "\"\nfile = \"e.csv\"\ncolumn = \"E\"\ntake = \"" + take + "\"\n";
    };
    EXPECT_EQ(plan_error(step + output("E", "mean") + output("E", "max")),
              "plan.toml:8: two columns would be called 'E'");
    EXPECT_EQ(plan_error(step + output("E_1", "mean") + output("E", "all")),
              "plan.toml:8: the columns of the outputs 'E_1' and 'E' would have equal names");
    EXPECT_EQ(plan_error(step + output("E", "all") + output("E_2", "mean")),
              "plan.toml:8: the columns of the outputs 'E' and 'E_2' would have equal names");
    EXPECT_EQ(plan_error(step + output("E", "all") + output("E_mean", "mean")), "");
}

TEST(SweepPlan, PathsBelowTheFolderHaveOneSpelling) {
    EXPECT_EQ(path_in_folder("a/../b//c/"), "b/c");
    EXPECT_EQ(path_in_folder("//etc/x"), "etc/x");
    for (const char* const path : {"..", "../x", "a/../../x", "a/..", ".", "", "/"})
        EXPECT_EQ(path_in_folder(path), "");
    EXPECT_EQ(plan_error(step + "[[output]]\nname = \"e\"\nfile = \"../e.csv\"\ncolumn = \"E\"\n"),
              "plan.toml:5: '../e.csv' is not below {dir}");
}

TEST(SweepPlan, ErrorsNameTheLineAndTheKey) {
    EXPECT_EQ(plan_error("titel = \"x\"\n" + step), "plan.toml:1: 'titel' is not known here");
    EXPECT_EQ(plan_error(step + "[[step]]\nname = \"b\"\n"), "plan.toml:3: 'run' is missing");
    EXPECT_EQ(plan_error(step + "acept = [0]\n"), "plan.toml:3: 'acept' is not known here");
    EXPECT_EQ(plan_error("[[vary]]\n\na = { from = 0, to = 1 }\n" + step),
              "plan.toml:3: the range 'a' needs either 'step' or 'count'");
    EXPECT_EQ(plan_error("[[vary]]\na = []\n" + step), "plan.toml:2: 'a' has no values");
    EXPECT_EQ(plan_error("[[vary]]\ncombine = \"zip\"\na = [1, 2]\nb = [3]\n" + step),
              "plan.toml:4: 'b' has 1 values where the lists before have 2");
    EXPECT_EQ(plan_error("[[vary]]\na = 1\n[[vary]]\na = 2\n" + step), "plan.toml:3: the parameter 'a' is given twice");
    EXPECT_EQ(plan_error("[[vary]]\ndir = 1\n" + step), "plan.toml:2: 'dir' cannot be a parameter");
    EXPECT_EQ(plan_error("[[vary]]\na = 1979-05-27\n" + step),
              "plan.toml:2: 'a' has a value that is neither text, a number, true nor false");
    EXPECT_EQ(plan_error("[scene]\ngenerate = \"complex\"\ntemplate = \"a.obj\"\n" + step),
              "plan.toml:1: a scene needs exactly one of 'generate', 'template' and 'files'");
    EXPECT_EQ(plan_error("[scene]\nfiles = \"/nowhere/*.obj\"\n" + step),
              "plan.toml:2: there is no file /nowhere/*.obj");
    EXPECT_EQ(plan_error(step + step), "plan.toml:3: two steps are called 'check'");
    EXPECT_EQ(plan_error(step + "[[output]]\nname = \"e\"\nstep = \"solve\"\njson = \"e\"\n"),
              "plan.toml:5: there is no step 'solve'");
    EXPECT_EQ(plan_error(step + "[[output]]\nname = \"e\"\nstep = \"check\"\njson = \"e\"\n"),
              "plan.toml:5: the step 'check' prints no JSON");
    EXPECT_EQ(plan_error(step + "[[output]]\nname = \"e\"\nfile = \"e.csv\"\ncolumn = \"e\"\ntake = \"median\"\n"),
              "plan.toml:7: 'median' is not one of value, mean, sum, min, max, all");
    EXPECT_EQ(plan_error("title = \"x\n"), plan_error("title = \"x\n"));
    EXPECT_EQ(plan_error("title = \"x\n").substr(0, 12), "plan.toml:1:");
    EXPECT_EQ(plan_error(""), "plan.toml:1: a plan needs at least one [[step]]");
}

}  // namespace exitance
