#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <map>

#include "cli/input_files.hpp"
#include "cli/process_runs.hpp"
#include "cli/small_scene.hpp"

namespace exitance::test {
namespace {

/// Verbs other than `solve` on one, two and three processes.
class VerbsOfProcesses : public ::testing::Test {
  protected:
    void SetUp() override {
        if (launcher.empty()) GTEST_SKIP() << "the build has no MPI";
        allow_any_processes();
        scene = write_small_room(folder);
    }

    /// Solves the room once, for verbs that read a solution.
    std::string solution() const {
        const std::string file = folder / "room.h5";
        if (std::filesystem::exists(file)) return file;
        EXPECT_EQ(run_program({"solve", scene, "-o", file, "--error", "0.1", "--light-groups"}).status, 0);
        return file;
    }
    /// The files of an output by their names: of a folder, or the file alone. Work files must be gone.
    static std::map<std::string, std::string> content_of(const std::filesystem::path& output) {
        std::map<std::string, std::string> files;
        if (!std::filesystem::is_directory(output)) {
            files["file"] = read_text(output);
            return files;
        }
        for (const auto& entry : std::filesystem::recursive_directory_iterator(output))
            if (entry.is_regular_file())
                files[std::filesystem::relative(entry.path(), output).string()] = read_text(entry.path());
        return files;
    }
    /// Expects equal files from one, two and three processes. `ending`: of the output; empty: a folder.
    void expect_same(const std::vector<std::string>& words, const std::string& ending,
                     const std::string& option = "-o") const {
        std::map<std::string, std::string> expected;
        for (int processes = 1; processes <= 3; ++processes) {
            const std::string output = folder / fmt::format("of_{}{}", processes, ending);
            std::filesystem::remove_all(output);
            std::vector<std::string> all = words;
            all.insert(all.end(), {option, output, "--threads", processes == 2 ? "2" : "1"});
            const Finished run = run_on(processes, all);
            EXPECT_EQ(run.status, 0) << run.err;
            const std::map<std::string, std::string> found = content_of(output);
            if (processes == 1) expected = found;
            EXPECT_FALSE(found.empty());
            ASSERT_EQ(found.size(), expected.size()) << processes << " processes";
            for (const auto& [name, content] : expected)
                EXPECT_TRUE(found.contains(name) && found.at(name) == content)
                    << words.front() << ", " << name << ", " << processes << " processes";
        }
    }
    /// A table of points on the floor, on a wall and in free space. `count` must be at least 3.
    std::string points(int count) const {
        std::string text = "x,y,z,nx,ny,nz\n";
        for (int i = 0; i < count; ++i) {
            const double s = (i + 0.5) / count;
            text += i % 3 == 0   ? fmt::format("{},{},0,0,0,1\n", 4 * s, 3 - 3 * s)
                    : i % 3 == 1 ? fmt::format("0,{},{},1,0,0\n", 3 * s, 2 * s)
                                 : fmt::format("{},{},1,0,0.6,0.8\n", 0.5 + 3 * s, 1 + s);
        }
        write_text(folder / "points.csv", text);
        return folder / "points.csv";
    }

    TemporaryFolder folder;
    std::string scene;
};

}  // namespace

TEST_F(VerbsOfProcesses, ProbeTheSameLight) {
    const std::string file = points(700);
    expect_same({"probe", solution(), "--points", file}, ".csv");
    expect_same({"probe", solution(), "--points", file, "--component", "indirect"}, ".csv");
    expect_same({"probe", solution(), "--points", file, "--interpolant"}, ".csv");
    expect_same({"probe", solution(), "--points", points(150), "--reference", "64"}, ".csv");
}

TEST_F(VerbsOfProcesses, ReadPointsFromStandardInputOfTheFirst) {
    const std::string text = read_text(points(30));
    const Finished one = run_on(1, {"probe", solution(), "--points", "-"}, text);
    const Finished two = run_on(2, {"probe", solution(), "--points", "-"}, text);
    EXPECT_EQ(two.status, 0) << two.err;
    EXPECT_EQ(two.out, one.out);
}

TEST_F(VerbsOfProcesses, RenderTheSamePictures) {
    const std::vector<std::string> camera{"render", solution(), "--camera",  "0.5,0.5,1.6 3,2,1 70",
                                          "--size", "150x100",  "--samples", "4"};
    const auto with = [&](const std::vector<std::string>& more) {
        std::vector<std::string> words = camera;
        words.insert(words.end(), more.begin(), more.end());
        return words;
    };
    expect_same(camera, ".exr");
    expect_same(with({"--isolux", "--mesh", "export"}), ".png");
    expect_same(with({"--gather", "16"}), ".hdr");
    write_text(folder / "path.csv", "time,ex,ey,ez,tx,ty,tz,fov\n0,0.5,0.5,1.6,3,2,1,70\n1,0.6,0.5,1.6,3,2,1,70\n");
    for (int processes = 1; processes <= 2; ++processes) {
        const std::string output = folder / fmt::format("walk{}.png", processes);
        const Finished run =
            run_on(processes, {"render", solution(), "--path", folder / "path.csv", "--size", "64x40", "-o", output});
        ASSERT_EQ(run.status, 0) << run.err;
    }
    for (const char* number : {"0001", "0002"})
        EXPECT_TRUE(read_text(folder / fmt::format("walk1.{}.png", number)) ==
                    read_text(folder / fmt::format("walk2.{}.png", number)));
}

TEST_F(VerbsOfProcesses, BakeTheSameMaps) {
    expect_same({"bake", solution(), "--density", "16"}, "");
    expect_same({"bake", solution(), "--density", "16", "--uv", "unwrap", "--light-groups"}, "");
}

/// The light of nodes on curved faces is gathered before the texels are baked.
TEST_F(VerbsOfProcesses, BakeTheSameCurvedSurfaces) {
    const std::string room = read_text(scene);
    std::string corners, normals, faces;
    constexpr int sides = 12;
    for (int i = 0; i < sides; ++i) {
        const double angle = 2 * 3.14159265358979 * i / sides, x = std::cos(angle), y = std::sin(angle);
        for (const double z : {0.2, 1.4}) corners += fmt::format("v {} {} {}\n", 1 + 0.4 * x, 1.5 + 0.4 * y, z);
        normals += fmt::format("vn {} {} 0\n", x, y);
        const int a = 13 + 2 * i, b = 13 + 2 * ((i + 1) % sides), na = i + 1, nb = (i + 1) % sides + 1;
        faces += fmt::format("f {}//{} {}//{} {}//{} {}//{}\n", a, na, b, nb, b + 1, nb, a + 1, na);
    }
    write_text(scene, room + corners + normals + "usemtl grey\ng column\n" + faces);
    expect_same({"bake", solution(), "--density", "12"}, "");
    expect_same({"bake", solution(), "--density", "12", "--uv", "unwrap"}, "");
}

TEST_F(VerbsOfProcesses, WriteTheSameViewFactors) {
    const std::vector<std::string> words{"viewfactors", scene, "--error", "0.01"};
    for (const char* ending : {".csv", ".mtx", ".h5"}) expect_same(words, ending);
    expect_same(words, ".h5", "--operator");
    expect_same({"viewfactors", scene, "--tolerance", "0.01"}, ".csv");
}

TEST_F(VerbsOfProcesses, FindTheSameDaylight) {
    const std::string court = write_court(folder);
    write_text(folder / "day.epw", weather_of_a_day());
    std::string sensors;
    for (int i = 0; i < 40; ++i) sensors += fmt::format("{} 1.5 0.8 0 0 1\n", 0.5 + 0.08 * i);
    write_text(folder / "p.pts", sensors);
    write_text(folder / "v.csv", "x,y,z,dx,dy,dz\n3,1,1.2,0,1,0\n2,1,1.2,,,\n");
    const std::vector<std::string> words{"daylight",       court,     "--epw", folder / "day.epw", "--points",
                                         folder / "p.pts", "--error", "0.1"};
    std::vector<std::string> with_views = words;
    with_views.insert(with_views.end(), {"--views", folder / "v.csv", "--matrix", "csv"});
    expect_same(with_views, "");
    // Parts on two processes each, merged by one, give the whole.
    std::vector<std::string> part = words;
    part.insert(part.end(), {"-o", folder / "parts", "--part", "1/2"});
    EXPECT_EQ(run_on(2, part).status, 0);
    part.back() = "2/2";
    EXPECT_EQ(run_on(2, part).status, 0);
    part.resize(part.size() - 2), part.push_back("--merge");
    EXPECT_EQ(run_on(2, part).status, 2) << "one process merges";
    EXPECT_EQ(run_on(1, part).status, 0);
    for (const char* name : {"hours.h5", "metrics.csv"})
        EXPECT_EQ(read_text(folder / (std::string("parts/") + name)), read_text(folder / (std::string("of_1/") + name)))
            << name;
}

TEST_F(VerbsOfProcesses, FailTogetherWithOneMessage) {
    const auto expect_failure = [&](int status, const std::vector<std::string>& words) {
        const Finished run = run_on(2, words);
        EXPECT_EQ(run.status, status) << words.front() << run.err;
        EXPECT_EQ(times(run.err, "error: "), 1u) << words.front() << run.err;
    };
    const std::string file = points(10);
    expect_failure(3, {"probe", folder / "none.h5", "--points", file});
    expect_failure(3, {"probe", solution(), "--points", folder / "none.csv"});
    expect_failure(5, {"probe", solution(), "--points", file, "-o", folder / "nowhere/p.csv"});
    expect_failure(5, {"render", solution(), "--size", "64x40", "-o", folder / "nowhere/p.png"});
    expect_failure(5, {"bake", solution(), "--density", "2", "-o", scene + "/maps"});
    expect_failure(5, {"viewfactors", scene, "-o", folder / "nowhere/f.csv"});
    expect_failure(3, {"daylight", scene, "--epw", folder / "none.epw", "--points", file, "-o", folder / "year"});
}

/// A signal to the last process stops all, and the finished points are written: the first ones of a whole run.
TEST_F(VerbsOfProcesses, StopTogetherAtASignalToOne) {
    const std::string file = points(20000), output = folder / "stopped.csv";
    RunningProgram run(
        launched(3, {"probe", solution(), "--points", file, "--reference", "4000", "-o", output, "--progress", "json"}),
        {}, launcher);
    const auto some_are_finished = [](const std::string& err) {
        return times(err, "\"fraction\":") > times(err, "\"fraction\":0.0,");
    };
    ASSERT_TRUE(run.wait_until(some_are_finished));
    ASSERT_EQ(kill(last_child(run.process()), SIGTERM), 0);
    const Finished finished = run.finish();
    EXPECT_EQ(finished.status, 143) << finished.err;
    EXPECT_EQ(times(finished.err, "points are finished"), 1u) << finished.err;
    EXPECT_GT(times(read_text(output), "\n"), 1u);
}

TEST_F(VerbsOfProcesses, KeepLimits) {
    const std::string file = points(20000), output = folder / "limited.csv";
    const Finished time =
        run_on(2, {"probe", solution(), "--points", file, "--reference", "4000", "-o", output, "--time-limit", "2"});
    EXPECT_TRUE(time.status == 4 || time.status == 5) << time.err;
    const Finished memory =
        run_on(2, {"probe", solution(), "--points", file, "--reference", "4000", "-o", output, "--memory-limit", "8M"});
    EXPECT_TRUE(memory.status == 4 || memory.status == 5) << memory.err;
    EXPECT_NE(memory.err.find("--memory-limit"), std::string::npos) << memory.err;
}

}  // namespace exitance::test
