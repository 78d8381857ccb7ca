#include "exitance/sweep/resolved_step.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "support/temporary_folder.hpp"

namespace exitance {
namespace {

void write(const std::string& path, const std::string& text) {
    std::ofstream(path) << text;
}

/// Keys of the steps of all variants of a plan.
std::vector<std::vector<std::string>> keys_of(const std::string& text, const std::string& path) {
    const Result<SweepPlan> plan = parse_sweep_plan(text, path);
    EXPECT_TRUE(plan) << plan.error().message;
    InputHashes hashes;
    std::vector<std::vector<std::string>> out;
    for (std::size_t i = 0; plan && i < plan->variants.size(); ++i) {
        const Result<ResolvedVariant> variant = resolve_variant(*plan, i, hashes);
        EXPECT_TRUE(variant) << variant.error().message;
        std::vector<std::string>& keys = out.emplace_back();
        if (variant)
            for (const ResolvedStep& step : variant->steps) keys.push_back(step.key);
    }
    return out;
}

std::string error_of(const std::string& text) {
    const Result<SweepPlan> plan = parse_sweep_plan(text, "plan.toml");
    if (!plan) return plan.error().message;
    InputHashes hashes;
    const Result<ResolvedVariant> variant = resolve_variant(*plan, 0, hashes);
    return variant ? "" : variant.error().where + ": " + variant.error().message;
}

}  // namespace

TEST(ResolvedSteps, VariantsThatDifferInALaterStepShareTheEarlierOnes) {
    const auto keys = keys_of(
        "[scene]\ngenerate = \"complex m=1\"\n[[vary]]\nlamp = [0, 1]\n[[step]]\nrun = \"solve {scene} -o "
        "{dir}/a.h5\"\n[[step]]\nrun = \"mix {dir}/a.h5 l={lamp} -o {dir}/b.h5\"\n[[step]]\nrun = \"stats "
        "{dir}/b.h5\"\n",
        "plan.toml");
    ASSERT_EQ(keys.size(), 2u);
    EXPECT_EQ(keys[0][0], keys[1][0]);
    EXPECT_EQ(keys[0][1], keys[1][1]);
    EXPECT_NE(keys[0][2], keys[1][2]);
    EXPECT_NE(keys[0][3], keys[1][3]) << "stats reads what mix writes";
}

TEST(ResolvedSteps, KeysFollowTheContentOfInputsAndOfTheFilesThatTheyName) {
    const TemporaryFolder folder, copy;
    const std::string plan = "[[step]]\nrun = \"solve room.obj -o {dir}/a.h5\"\n[[step]]\nrun = \"stats {dir}/a.h5\"\n";
    write(folder / "room.obj", "mtllib my room.mtl\nv 0 0 0\n"), write(folder / "my room.mtl", "newmtl a\nKd 1 1 1\n");
    const auto before = keys_of(plan, folder / "plan.toml");
    EXPECT_EQ(keys_of(plan, folder / "plan.toml"), before);
    write(copy / "room.obj", "mtllib my room.mtl\nv 0 0 0\n"), write(copy / "my room.mtl", "newmtl a\nKd 1 1 1\n");
    EXPECT_EQ(keys_of(plan, copy / "plan.toml"), before) << "folders do not matter";
    write(folder / "my room.mtl", "newmtl a\nKd 0 1 1\n");
    const auto after = keys_of(plan, folder / "plan.toml");
    EXPECT_NE(after[0][0], before[0][0]);
    EXPECT_NE(after[0][1], before[0][1]) << "later steps depend on it";
}

TEST(ResolvedSteps, AChangedInputOfALaterStepLeavesTheEarlierOnes) {
    const TemporaryFolder folder;
    const std::string plan =
        "[[step]]\nrun = \"solve room.obj -o {dir}/a.h5\"\n[[step]]\nrun = \"probe {dir}/a.h5 "
        "--points p.csv -o {dir}/p.csv\"\n";
    write(folder / "room.obj", "v 0 0 0\n"), write(folder / "p.csv", "x,y,z\n");
    const auto before = keys_of(plan, folder / "plan.toml");
    write(folder / "p.csv", "x,y,z\n1,1,1\n");
    const auto after = keys_of(plan, folder / "plan.toml");
    EXPECT_EQ(after[0][0], before[0][0]);
    EXPECT_NE(after[0][1], before[0][1]);
}

TEST(ResolvedSteps, PartsOfWordsAndDeclaredInputsCount) {
    const TemporaryFolder folder;
    const std::string plan =
        "[[step]]\nrun = \"solve room.obj --sky image=sky.hdr,rotation=3 -o {dir}/a.h5\"\ninputs = "
        "[\"data/*.bin\"]\n";
    std::filesystem::create_directory(folder / "data");
    write(folder / "room.obj", ""), write(folder / "sky.hdr", "1"), write(folder / "data/a.bin", "1");
    const auto before = keys_of(plan, folder / "plan.toml");
    write(folder / "sky.hdr", "2");
    const auto other_sky = keys_of(plan, folder / "plan.toml");
    EXPECT_NE(other_sky, before);
    write(folder / "data/a.bin", "2");
    EXPECT_NE(keys_of(plan, folder / "plan.toml"), other_sky);
}

TEST(ResolvedSteps, TemplatesOfEqualTextsShareAllSteps) {
    const TemporaryFolder folder;
    write(folder / "room.obj", "mtllib room.mtl\nv {{width}} 0 0\n"), write(folder / "room.mtl", "Kd 1 1 1\n");
    const std::string text =
        "[scene]\ntemplate = \"room.obj\"\n[[vary]]\nwidth = [4, 4.0, 5]\n[[step]]\nrun = \"check "
        "{scene}\"\n";
    const auto keys = keys_of(text, folder / "plan.toml");
    EXPECT_EQ(keys[0], keys[1]);
    EXPECT_NE(keys[0], keys[2]);
    const Result<SweepPlan> plan = parse_sweep_plan(text, folder / "plan.toml");
    InputHashes hashes;
    const Result<ResolvedVariant> variant = resolve_variant(*plan, 2, hashes);
    const std::vector<std::pair<std::string, std::string>> texts{{"room.obj", "mtllib room.mtl\nv 5 0 0\n"},
                                                                 {"room.mtl", "Kd 1 1 1\n"}};
    EXPECT_EQ(variant->steps[0].texts, texts) << "material files are copied";
    write(folder / "room.obj", "v 0 0 0\nv {{wdith}} 0 0\n");
    const Result<ResolvedVariant> wrong = resolve_variant(*plan, 0, hashes);
    ASSERT_FALSE(wrong);
    EXPECT_EQ(wrong.error().where, (folder / "room.obj") + ":2");
}

TEST(ResolvedSteps, NamesOfFilesMayHaveBlanksAndCommas) {
    const Result<SweepPlan> plan = parse_sweep_plan(
        "[[step]]\nrun = \"solve a.obj -o '{dir}/my room, big.h5'\"\n[[step]]\nrun = \"mix '{dir}/my room, big.h5' -o "
        "{dir}/b.h5\"\n[[step]]\nrun = \"probe {dir}/b.h5 --points '{dir}/my room, big.h5,{dir}/b.h5' "
        "--output='{dir}/my "
        "light.csv'\"\n[[output]]\nname = \"E\"\nfile = \"my light.csv\"\ncolumn = \"E_g\"\n",
        "/p/plan.toml");
    ASSERT_TRUE(plan) << plan.error().message;
    InputHashes hashes;
    const Result<ResolvedVariant> variant = resolve_variant(*plan, 0, hashes);
    ASSERT_TRUE(variant) << variant.error().message;
    const std::vector<ResolvedStep>& steps = variant->steps;
    EXPECT_EQ(steps[0].outputs, (std::vector<std::string>{"my room, big.h5"}));
    const std::string folder = "/p/plan.sweep/steps/", room = folder + steps[0].key + "/my room, big.h5";
    EXPECT_EQ(steps[1].words[1], room);
    EXPECT_EQ(steps[2].words[3], room + "," + folder + steps[1].key + "/b.h5");
    EXPECT_EQ(steps[2].outputs, (std::vector<std::string>{"my light.csv"}));
    EXPECT_EQ(variant->output_steps, (std::vector<std::size_t>{2}));
}

TEST(ResolvedSteps, OutputsOutsideOfTheFolderAreErrorsInAllSpellings) {
    for (const char* const output :
         {"-o {dir}/../r.h5", "-o {dir}/a/../../x", "--output={dir}/..", "-o{dir}/../r.h5", "-o /r.h5", "-o/r.h5",
          "-vo r.h5", "--output r.h5", "-o {dir}/.", "-o {dir}//", "--output=r.h5"})
        EXPECT_NE(
            error_of("[[step]]\nrun = \"solve a.obj " + std::string(output) + "\"\n").find("which is not below {dir}"),
            std::string::npos)
            << output;
    EXPECT_EQ(error_of("[[step]]\nrun = \"check a.obj --picture {dir}/../p.csv\"\n"),
              "plan.toml:2: 'run' of step 'check' has {dir}/../p.csv, which is not a file below {dir}");
    EXPECT_EQ(error_of("[[step]]\nrun = \"check a.obj --picture {dir}.csv\"\n"),
              "plan.toml:2: 'run' of step 'check' has {dir}.csv, which is not a file below {dir}");
    EXPECT_EQ(
        error_of(
            "[[step]]\nrun = \"solve a.obj -o {dir}/a.h5\"\n[[step]]\nrun = \"mix {dir}/a.h5 -o {dir}/b/.././a.h5\"\n"),
        "plan.toml:4: step 'mix' writes {dir}/a.h5, which is a file of step 'solve'");
    EXPECT_EQ(error_of("[[step]]\nrun = \"solve a.obj -o {dir}/status.txt\"\n"),
              "plan.toml:2: 'run' of step 'solve' has {dir}/status.txt, a name that is not possible");
    EXPECT_EQ(error_of("[[step]]\nrun = \"solve a.obj -o -\"\n"), "");
}

TEST(ResolvedSteps, PlaceholdersOfTemplatesMayHaveBlanks) {
    const TemporaryFolder folder;
    const std::string text = "[scene]\ntemplate = \"a.obj\"\n[[vary]]\nwall = 0.5\n[[step]]\nrun = \"check {scene}\"\n";
    const Result<SweepPlan> plan = parse_sweep_plan(text, folder / "plan.toml");
    InputHashes hashes;
    write(folder / "a.obj", "v {{ wall }} {{\twall}} {{wall}}\n");
    const Result<ResolvedVariant> variant = resolve_variant(*plan, 0, hashes);
    ASSERT_TRUE(variant) << variant.error().message;
    EXPECT_EQ(variant->steps[0].texts[0].second, "v 0.5 0.5 0.5\n");
    write(folder / "a.obj", "v {{wall}}\nv {{ wal }}\n");
    const Result<ResolvedVariant> misspelled = resolve_variant(*plan, 0, hashes);
    ASSERT_FALSE(misspelled);
    EXPECT_EQ(misspelled.error().hint, "did you mean {{wall}}?");
    EXPECT_EQ(misspelled.error().where, (folder / "a.obj") + ":2");
    write(folder / "a.obj", "v {{wall\nv }}\n");
    const Result<ResolvedVariant> open = resolve_variant(*plan, 0, hashes);
    ASSERT_FALSE(open);
    EXPECT_EQ(open.error().message, "'{{' is not followed by a name and '}}'");
    write(folder / "a.obj", "v {{wall} {{wall}}\n");
    const Result<ResolvedVariant> single = resolve_variant(*plan, 0, hashes);
    ASSERT_FALSE(single);
    EXPECT_EQ(single.error().message, open.error().message);
}

TEST(ResolvedSteps, ErrorsNameTheLineOfTheStep) {
    EXPECT_EQ(error_of("\n[[step]]\nrun = \"solve a.obj -o {dri}/a.h5\"\n"),
              "plan.toml:3: there is no parameter 'dri' for the placeholder {dri}");
    EXPECT_EQ(error_of("[[step]]\nrun = \"solve a.obj -o a.h5\"\n"),
              "plan.toml:2: 'run' of step 'solve' writes a.h5, which is not below {dir}");
    EXPECT_EQ(error_of("[[step]]\nrun = \"bake a.h5 -o {dir}\"\n"),
              "plan.toml:2: 'run' of step 'bake' writes {dir}, which is not below {dir}");
    EXPECT_EQ(
        error_of("[[step]]\nrun = \"solve a.obj -o {dir}/a.h5\"\n[[step]]\nrun = \"mix {dir}/a.h5 -o {dir}/a.h5\"\n"),
        "plan.toml:4: step 'mix' writes {dir}/a.h5, which is a file of step 'solve'");
    EXPECT_EQ(error_of("[[step]]\nrun = \"stats a.h5\"\n[[output]]\nname = \"x\"\nfile = \"x.csv\"\ncolumn = \"E\"\n"),
              "plan.toml:3: no step writes {dir}/x.csv, the 'file' of output 'x'");
    EXPECT_EQ(error_of("[[vary]]\nm = [[\"a\", \"b\"]]\n[[step]]\nrun = \"stats a{m}.h5\"\n"),
              "plan.toml:4: the value of 'm' is a list, and {m} is part of a word");
}

}  // namespace exitance
