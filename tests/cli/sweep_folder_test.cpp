// The folder of a sweep: damaged steps, failed steps, folders of variants, names with blanks.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>

#include "cli/room_sweep.hpp"

namespace exitance::test {
namespace {

namespace fs = std::filesystem;

/// Two variants with two quick steps each.
constexpr const char* quick_plan = R"([[vary]]
nx = [1, 2]
[[step]]
run = "generate office nx={nx} ny=1 -o '{dir}/my room.obj'"
[[step]]
run = "check '{dir}/my room.obj' --json"
[[output]]
name = "faces"
step = "check"
json = "surfaces"
)";

fs::path folder_of_step(const TemporaryFolder& folder, const std::string& variant, const std::string& step) {
    const Json record = Json::parse(read_text(folder / ("plan.sweep/variants/" + variant + "/variant.json")));
    return folder / ("plan.sweep/steps/" + record["steps"][step].get<std::string>());
}

}  // namespace

TEST(ProgramSweep, FilesWithBlanksInTheirNamesAreCollected) {
    const TemporaryFolder folder;
    std::string text = with(plan_of_room, "-o {dir}/light.csv", "-o '{dir}/my light.csv'");
    for (int i = 0; i < 2; ++i) text = with(text, "file = \"light.csv\"", "file = \"my light.csv\"");
    const std::string plan = write_plan(folder, text);
    const Finished run = sweep(plan, {"--local", "2", "--collect"});
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_TRUE(fs::exists(folder / "plan.sweep/variants/0004/my light.csv"));
}

TEST(ProgramSweep, DamagedStepsAreRunAgainWithAWarning) {
    const TemporaryFolder folder;
    const std::string plan = write_plan(folder, quick_plan);
    ASSERT_EQ(sweep(plan, {"--local", "1"}).status, 0);
    const std::string table = table_of(folder);
    const fs::path made = folder_of_step(folder, "0001", "generate"), checked = folder_of_step(folder, "0001", "check");
    const std::vector<std::function<void()>> damages{
        [&] { fs::remove(made / "my room.obj"); },
        [&] { fs::remove(made / "my room.mtl"); },
        [&] { fs::resize_file(checked / "stdout.txt", 5); },
        [&] { std::ofstream(made / "status.txt") << ""; },
        [&] { fs::remove(checked / "status.txt"); },
        [&] { fs::remove_all(made), std::ofstream(made) << "a file in its place"; },
    };
    for (const std::function<void()>& damage : damages) {
        damage();
        EXPECT_EQ(states_of(plan), "to do,done");
        const Finished listed = sweep(plan, {"--list"});
        EXPECT_NE(listed.out.find("is damaged: "), std::string::npos) << listed.out;
        EXPECT_EQ(sweep(plan, {"--collect", "-o", folder / "part.csv"}).status, 4);
        const Finished healed = sweep(plan, {"--run", "1", "--json"});
        EXPECT_EQ(healed.status, 0) << healed.err;
        EXPECT_EQ(report_of(healed)["steps_run"], 1) << "later steps depend on the content, which is unchanged";
        EXPECT_NE(healed.err.find("; it was run again"), std::string::npos) << healed.err;
        EXPECT_EQ(table_of(folder), table);
    }
    fs::remove(folder / "plan.sweep/variants/0001/my room.obj");
    EXPECT_EQ(report_of(sweep(plan, {"--run", "1", "--json"}))["steps_run"], 0);
    EXPECT_TRUE(fs::exists(folder / "plan.sweep/variants/0001/my room.obj")) << "a lost link is made again";
}

/// Messages name the folder that is kept, and the command can be run in a shell.
TEST(ProgramSweep, FailedStepsKeepWhatTheyPrintedAndTheirCommand) {
    const TemporaryFolder folder;
    const std::string plan = write_plan(
        folder, "[[step]]\nrun = \"solve room.obj -o '{dir}/my room.h5' --error 0.001 --time-limit 0.00001 --json\"\n");
    write_small_room(folder);
    const Finished run = sweep(plan, {"--local", "1"});
    EXPECT_EQ(run.status, 4) << run.err;
    std::vector<fs::path> failed;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder / "plan.sweep/steps"))
        if (entry.path().extension() == ".failed") failed.push_back(entry.path());
    ASSERT_EQ(failed.size(), 1u);
    EXPECT_NE(run.err.find("; see " + failed[0].string()), std::string::npos) << run.err;
    EXPECT_NE(run.err.find(failed[0].string() + "/my room.h5: the time limit"), std::string::npos) << run.err;
    const Json record = Json::parse(read_text(failed[0] / "failure.json"));
    EXPECT_EQ(record["command"].get<std::string>().find("exitance solve room.obj -o '" + failed[0].string() +
                                                        "/my room.h5' --error 0.001"),
              0u)
        << record["command"];
    for (const std::string& text :
         {run.err, read_text(failed[0] / "stderr.txt"), record.dump(), sweep(plan, {"--list"}).out}) {
        EXPECT_EQ(text.find("/steps/."), std::string::npos) << text;
        EXPECT_EQ(text.find("{dir}"), std::string::npos) << text;
        EXPECT_NE(text.find("the time limit"), std::string::npos) << text;
    }
    write_text(plan, with(read_text(plan), "--time-limit 0.00001 ", ""));
    write_text(plan, with(read_text(plan), "0.001", "0.5"));
    EXPECT_EQ(sweep(plan, {"--local", "1"}).status, 0);
    const fs::path step = folder_of_step(folder, "0001", "solve");
    for (const char* const name : {"stdout.txt", "stderr.txt"})
        EXPECT_EQ(read_text(step / name).find("/steps/."), std::string::npos) << read_text(step / name);
}

TEST(ProgramSweep, FoldersOfVariantsThatThePlanNoLongerHasAreRemoved) {
    const TemporaryFolder folder;
    const std::string plan = write_plan(folder, quick_plan);
    ASSERT_EQ(sweep(plan, {"--local", "1"}).status, 0);
    const std::string variants = folder / "plan.sweep/variants/";
    write_text(variants + "0002/notes.txt", "mine");
    fs::create_directory(variants + "0003");
    write_text(variants + "0003/mine.txt", "mine");
    fs::create_directory(variants + "0007");
    fs::copy_file(variants + "0001/variant.json", variants + "0007/variant.json");
    write_text(plan, with(quick_plan, "[1, 2]", "[1]"));
    EXPECT_EQ(sweep(plan, {"--local", "1"}).status, 0);
    EXPECT_TRUE(fs::exists(variants + "0001/my room.obj"));
    EXPECT_FALSE(fs::is_symlink(variants + "0002/my room.obj"));
    EXPECT_FALSE(fs::exists(variants + "0002/variant.json"));
    EXPECT_EQ(read_text(variants + "0002/notes.txt"), "mine");
    EXPECT_EQ(read_text(variants + "0003/mine.txt"), "mine");
    EXPECT_TRUE(fs::exists(variants + "0007/variant.json")) << "the record is of another variant";

    fs::remove(variants + "0002/notes.txt"), fs::remove(variants + "0002");
    write_text(plan, with(quick_plan, "[1, 2]", "[1, 2, 3]"));
    EXPECT_EQ(sweep(plan, {"--local", "1"}).status, 0);
    EXPECT_TRUE(fs::exists(variants + "0003/my room.obj")) << "a folder with a file of the user is filled";
    write_text(plan, with(quick_plan, "[1, 2]", "[2]"));
    EXPECT_EQ(sweep(plan, {"--collect"}).status, 0) << "variant 1 now has the steps of the former variant 2";
    EXPECT_EQ(Json::parse(read_text(variants + "0001/variant.json"))["parameters"]["nx"], "2");
    EXPECT_FALSE(fs::exists(variants + "0002"));
    EXPECT_EQ(read_text(variants + "0003/mine.txt"), "mine");
}

TEST(ProgramSweep, AFailedVariantDoesNotKeepResultsOfOtherParameters) {
    const TemporaryFolder folder;
    const std::string plan = write_plan(folder, quick_plan);
    ASSERT_EQ(sweep(plan, {"--local", "1"}).status, 0);
    write_text(plan, with(quick_plan, "[1, 2]", "[1, -2]"));
    EXPECT_EQ(sweep(plan, {"--local", "1"}).status, 4);
    EXPECT_TRUE(fs::exists(folder / "plan.sweep/variants/0001"));
    EXPECT_FALSE(fs::exists(folder / "plan.sweep/variants/0002"));
}

TEST(ProgramSweep, MessagesOfFoldersThatCannotBeMadeNameTheCause) {
    const TemporaryFolder folder;
    const std::string plan = write_plan(folder, quick_plan);
    write_text(folder / "plan.sweep", "a file");
    for (const std::vector<std::string>& words : {std::vector<std::string>{"--local", "1"}, {"--collect"}}) {
        const Finished run = sweep(plan, words);
        EXPECT_NE(run.status, 0);
        EXPECT_NE(run.err.find("a file has the name of one of its folders"), std::string::npos) << run.err;
    }
}

TEST(ProgramSweep, LikelyMistakesOfPlansAreWarnings) {
    const TemporaryFolder folder;
    const std::string plan = write_plan(folder, with(quick_plan, "[1, 2]", "[1, 1]\nwall = 0.5"));
    const Finished listed = sweep(plan, {"--list", "--json"});
    EXPECT_EQ(listed.status, 0);
    EXPECT_NE(listed.err.find("warning: " + plan + ": no command and no template uses the parameter 'wall'"),
              std::string::npos)
        << listed.err;
    EXPECT_NE(listed.err.find("variants 1 and 2 have equal parameters"), std::string::npos) << listed.err;
}

TEST(ProgramSweep, AnOutputWithTwoColumnsOfOneNameIsNotCollected) {
    const TemporaryFolder folder;
    const std::string plan = write_plan(
        folder,
        "[scene]\ntemplate = [\"room.obj\", \"room.mtl\", \"t.csv\"]\n[[vary]]\nwall = 0.5\n[[step]]\nrun = \"check "
        "{scene}\"\n[[output]]\nname = \"E\"\nfile = \"t.csv\"\ncolumn = \"E\"\n");
    write_text(folder / "t.csv", "E,F,E\n1,2,{{wall}}\n");
    ASSERT_EQ(sweep(plan, {"--local", "1"}).status, 0);
    const Finished collected = sweep(plan, {"--collect"});
    EXPECT_EQ(collected.status, 4);
    EXPECT_NE(collected.err.find("there are 2 columns 'E'"), std::string::npos) << collected.err;
}

}  // namespace exitance::test
