#include "exitance/io/files/scene_program.hpp"

#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <thread>

#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/scenes/scene_file.hpp"
#include "support/own_programs.hpp"
#include "support/temporary_folder.hpp"

namespace exitance {
namespace {

namespace fs = std::filesystem;
using Clock = StopRequest::Clock;

/// Loads scenes with the test's own programs in place of Radiance's.
class ScenePrograms : public OwnPrograms {
  protected:
    CheckedScene load(const std::string& text, bool run_commands) {
        EXPECT_TRUE(write_file(folder_ / "s.rad", text));
        const std::string path = folder_ / "s.rad";
        return load_scene(std::span(&path, 1), {.run_commands = run_commands});
    }
    const StopRequest never_{};
};

constexpr const char* grey = "void plastic grey 0 0 5 .5 .5 .5 0 0\nvoid light lamp 0 0 3 1 1 1\n";
constexpr const char* square = "echo $1 polygon $2 0 0 12 0 0 0 1 0 0 1 1 0 0 1 0\n";

}  // namespace

TEST_F(ScenePrograms, GetTheirInputAndReportWhyTheyFail) {
    make("genprism", "cat; echo \"$1 and $2\"\n");
    const auto printed = run_scene_program({"genprism", "a b", "*"}, "first\n", "", never_);
    ASSERT_TRUE(printed) << printed.error().message;
    EXPECT_EQ(*printed, "first\na b and *\n") << "no shell has a hand in it";
    make("genrev", "echo 'it is Monday' >&2; echo more >&2; exit 3\n");
    EXPECT_EQ(run_scene_program({"genrev"}, "", "", never_).error().message, "'genrev' fails: it is Monday");
    EXPECT_NE(run_scene_program({"rm", "x"}, "", "", never_).error().message.find("not a Radiance program"),
              std::string::npos);
    EXPECT_NE(run_scene_program({"genclock"}, "", "", never_).error().message.find("not installed"), std::string::npos);
}

TEST_F(ScenePrograms, EndWhenAStopIsRequested) {
    make("gensurf", "echo $$ > " + std::string(folder_ / "pid") + "\nsleep 1000 & sleep 1000\n");
    StopRequest stop;
    stop.set_deadline(Clock::now() + std::chrono::milliseconds(400));
    const auto begin = Clock::now();
    const auto printed = run_scene_program({"gensurf"}, "", "", stop);
    ASSERT_FALSE(printed);
    EXPECT_EQ(printed.error().code, ErrorCode::limit);
    EXPECT_LT(std::chrono::duration<double>(Clock::now() - begin).count(), 20);
    const auto pid = read_whole_file(folder_ / "pid");
    if (pid) {
        EXPECT_NE(::kill(std::stoi(*pid), 0), 0) << "the program is gone";
    }
}

TEST_F(ScenePrograms, RunOnlyIfTheUserAllowsThem) {
    const std::string mark = folder_ / "mark";
    make("genprism", std::string("touch ") + mark + "\n" + square);
    const std::string text = std::string(grey) + "!genprism grey box 1 2 3\nlamp polygon l 0 0 9 0 0 1 1 0 1 0 1 1\n";
    const CheckedScene refused = load(text, false);
    ASSERT_FALSE(refused.scene);
    EXPECT_NE(refused.scene.error().hint.find("--run-commands"), std::string::npos);
    EXPECT_FALSE(fs::exists(mark));
    const CheckedScene read = load(text, true);
    ASSERT_TRUE(read.scene) << read.scene.error().message;
    EXPECT_TRUE(fs::exists(mark));
    ASSERT_EQ(read.scene->surfaces().size(), 3u);
    EXPECT_EQ(read.scene->surfaces()[SurfaceId(0)].line, 3);
}

TEST_F(ScenePrograms, HaveTheirOutputTransformedByXform) {
    make("genprism", square);
    const CheckedScene s = load(std::string(grey) +
                                    "!genprism grey box 1 2 3 | xform -n two -t 0 0 1 -a 2 -t 5 0 0 | xform -s 2\n"
                                    "lamp polygon l 0 0 9 0 0 9 1 0 9 0 1 9\n",
                                true);
    ASSERT_TRUE(s.scene) << s.scene.error().message;
    ASSERT_EQ(s.scene->surfaces().size(), 5u);
    EXPECT_EQ(s.scene->outline(SurfaceId(2))[0], (Point{10, 0, 2}));
    EXPECT_EQ(s.scene->groups()[GroupId(0)], "two.box");
    make("genprism", "echo grey polygon p 0 0 x\n");
    const CheckedScene broken = load(std::string(grey) + "!genprism grey box 1 2 3\n", true);
    ASSERT_FALSE(broken.scene);
    EXPECT_EQ(broken.scene.error().where, std::string(folder_ / "s.rad") + ":3: '!genprism':1");
}

TEST_F(ScenePrograms, SeveralFilesMakeAScene) {
    ASSERT_TRUE(write_file(folder_ / "m.rad", grey));
    ASSERT_TRUE(write_file(folder_ / "r.rad",
                           "grey polygon f 0 0 12 0 0 0 1 0 0 1 1 0 0 1 0\n\n"
                           "grey polygon flat 0 0 9 0 0 0 1 0 0 2 0 0\n"));
    ASSERT_TRUE(write_file(folder_ / "l.obj", "v 0 0 1\nv 0 1 1\nv 1 1 1\nf 1 2 3\n"));
    ASSERT_TRUE(write_file(folder_ / "s.rad", "lamp polygon l 0 0 9 0 0 2 0 1 2 1 1 2\n"));
    const std::vector<std::string> files = {folder_ / "m.rad", folder_ / "r.rad", folder_ / "l.obj", folder_ / "s.rad"};
    const CheckedScene s = load_scene(files, {});
    ASSERT_TRUE(s.scene) << s.scene.error().message;
    ASSERT_EQ(s.scene->surfaces().size(), 4u);
    EXPECT_EQ(s.scene->emitters().size(), 1u);
    EXPECT_TRUE(std::ranges::any_of(s.findings, [&](const Finding& f) { return f.file == files[1] && f.line == 3; }))
        << "the face without area is told in its own file";
    const std::vector<std::string> turned = {files[1], files[0]};
    const CheckedScene wrong = load_scene(turned, {});
    ASSERT_FALSE(wrong.scene);
    EXPECT_EQ(wrong.scene.error().where, files[1] + ":1");
    const std::vector<std::string> twice = {files[0], files[1], files[0]};
    EXPECT_EQ(load_scene(twice, {}).scene.error().code, ErrorCode::usage);
}

}  // namespace exitance
