#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>

#include "cli/input_files.hpp"
#include "cli/small_scene.hpp"

namespace exitance::test {
namespace {

std::string first_line_of(const std::string& text) {
    return text.substr(0, text.find('\n'));
}

std::size_t lines(const std::string& text) {
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace

TEST(ProgramSky, ASolutionUnderASkyIsReadBack) {
    const TemporaryFolder folder;
    const Finished run = run_program({"solve", write_court(folder), "-o", folder / "s.h5", "--error", "0.1", "-q",
                                      "--sky", "perez,altitude=50,azimuth=180,dni=600,dhi=120"});
    ASSERT_EQ(run.status, 0) << run.err;
    const std::string points = "x,y,z,nx,ny,nz\n3.5,2,0,0,0,1\n1,1.5,3,0,0,1\n";
    const Finished probe = run_program({"probe", folder / "s.h5", "--points", "-", "-o", "-"}, points);
    ASSERT_EQ(probe.status, 0) << probe.err;
    // Above the scene, the irradiance is that of the whole sky and the sun; little light is reflected upwards.
    const std::string last = probe.out.substr(probe.out.rfind("1,1.5,3,"));
    EXPECT_NEAR(std::stod(last.substr(std::string("1,1.5,3,0,0,1,").size())),
                120 + 600 * std::sin(50 * 3.14159265 / 180), 2);
    EXPECT_EQ(run_program({"render", folder / "s.h5", "-o", folder / "s.png", "--size", "32x24"}).status, 0);
    EXPECT_EQ(run_program({"export", folder / "s.h5", "-o", folder / "s.glb"}).status, 0);
}

TEST(ProgramSky, ASkyAloneIsASceneForProbe) {
    const TemporaryFolder folder;
    write_text(folder / "empty.obj", "# no faces\n");
    const double horizontal = 120 + 600 * std::sin(50 * 3.14159265 / 180);
    const std::vector<std::pair<std::string, std::vector<double>>> skies{
        // Irradiance upwards, towards the east (of the perez sky: any), and downwards. The ground half of a sky
        // reflects a fifth of the horizontal irradiance.
        {"uniform,dhi=100", {100, 60, 20}},
        {"perez,altitude=50,azimuth=180,dni=600,dhi=120", {horizontal, -1, 0.2 * horizontal}}};
    for (const auto& [sky, expected] : skies) {
        const Finished run =
            run_program({"solve", folder / "empty.obj", "-o", folder / "s.h5", "--sky", sky, "--json", "-q"});
        ASSERT_EQ(run.status, 0) << run.err;
        for (const bool by_paths : {false, true}) {
            std::vector<std::string> words{"probe", folder / "s.h5", "--points", "-", "-o", "-"};
            if (by_paths) words.insert(words.end(), {"--reference", "64"});
            const Finished probe = run_program(words, "x,y,z,nx,ny,nz\n0,0,0,0,0,1\n3,-20,1.5,1,0,0\n0,0,0,0,0,-1\n");
            ASSERT_EQ(probe.status, 0) << probe.err;
            std::istringstream rows(probe.out);
            std::string row;
            std::getline(rows, row);
            for (const double light : expected) {
                ASSERT_TRUE(std::getline(rows, row));
                std::istringstream fields(row);
                std::string field;
                for (int i = 0; i < 7; ++i) std::getline(fields, field, ',');
                if (light >= 0) {
                    EXPECT_NEAR(std::stod(field), light, 1e-3 * light + 1e-9) << row;
                } else {
                    EXPECT_GT(std::stod(field), 0) << row;
                }
            }
        }
    }
    EXPECT_EQ(run_program({"solve", folder / "empty.obj", "-o", folder / "s.h5"}).status, 3) << "neither sky nor face";
}

TEST(ProgramSky, LightMirroredByPanesIsInSolutionsAndReferences) {
    const TemporaryFolder folder;
    write_text(folder / "front.rad",
               "void glass pane\n0\n0\n4 .9 .9 .9 4\nvoid plastic black\n0\n0\n5 0 0 0 0 0\n"
               "pane polygon front\n0\n0\n12 -10 6 0 10 6 0 10 6 20 -10 6 20\n"
               "black polygon floor\n0\n0\n12 -20 -20 0 20 -20 0 20 6 0 -20 6 0\n"
               "void glow g\n0\n0\n4 30 30 30 0\ng source up\n0\n0\n4 0 0 1 180\n");
    const Finished run = run_program({"solve", folder / "front.rad", "-o", folder / "f.h5", "--error", "0.05", "-q"});
    EXPECT_EQ(run.status, 0) << run.err;
    const auto light = [&](std::vector<std::string> words) {
        words.insert(words.begin(), {"probe", folder / "f.h5", "--points", "-", "-o", "-"});
        const Finished probe = run_program(words, "x,y,z,nx,ny,nz\n0,5,1,0,1,0\n");
        EXPECT_EQ(probe.status, 0) << probe.err;
        std::string row = probe.out.substr(probe.out.find('\n') + 1);
        for (int column = 0; column < 6; ++column) row.erase(0, row.find(',') + 1);
        return std::stod(row);
    };
    const double expected = light({"--reference", "16384"});
    // Behind the pane half of the sky is seen through it, 30 pi / 2 at most; the mirrored sky is more than a tenth.
    EXPECT_GT(expected, 5);
    EXPECT_NEAR(light({}), expected, 0.05 * expected);  // the requested error
}

TEST(ProgramSky, OlderGenskyIsAnOption) {
    const TemporaryFolder folder;
    write_text(folder / "s.rad",
               "! gensky 12 9 14 -a 51 -o 0 -m 0 -u\nvoid plastic grey\n0\n0\n5 .2 .2 .2 0 0\n"
               "grey polygon plate\n0\n0\n12 0 0 0 1 0 0 1 1 0 0 1 0\nskyfunc glow g\n0\n0\n4 1 1 1 0\n"
               "g source up\n0\n0\n4 0 0 1 180\n");
    const auto light = [&](const std::vector<std::string>& more) {
        std::vector<std::string> words{"solve", folder / "s.rad", "-o", folder / "s.h5", "-q", "--error", "0.1"};
        words.insert(words.end(), more.begin(), more.end());
        EXPECT_EQ(run_program(words).status, 0);
        const Finished probe =
            run_program({"probe", folder / "s.h5", "--points", "-", "-o", "-"}, "x,y,z,nx,ny,nz\n0.5,0.5,1,0,0,1\n");
        return std::stod(probe.out.substr(probe.out.find("0.5,0.5,1,0,0,1,") + 16));
    };
    const double today = light({}), older = light({"--older-gensky"});
    // The zenith luminance grows with the sun's altitude h, here by a degree: 8.6 sin h + 0.123.
    EXPECT_GT(older, 1.01 * today);
    EXPECT_LT(older, 1.1 * today);
}

TEST(ProgramSky, InvalidOptionsAreUsageErrors) {
    const TemporaryFolder folder;
    const std::string scene = write_court(folder), out = folder / "s.h5";
    const Finished kind = run_program({"solve", scene, "-o", out, "--sky", "grey,dhi=100"});
    EXPECT_EQ(kind.status, 2);
    EXPECT_EQ(kind.err.find("error: --sky: 'grey' is not a kind of sky\nhint: kinds: uniform, overcast"), 0u)
        << kind.err;
    EXPECT_EQ(run_program({"solve", scene, "-o", out, "--epw", "x.epw"}).status, 2);
    EXPECT_EQ(
        run_program({"solve", scene, "-o", out, "--sky", "perez,time=06-21T12:00", "--epw", folder / "x.epw"}).status,
        3);
}

TEST(ProgramDaylight, TakesAHoneybeeModelWithItsGridsAndWritesResultsForHoneybee) {
    const TemporaryFolder folder;
    // A floor below the open sky: the light of each hour is that of a sensor in the open.
    write_text(folder / "open.hbjson", R"({"type": "Model", "properties": {"radiance": {"sensor_grids": [
        {"identifier": "a/b", "sensors": [{"pos": [1, 1, 0.8], "dir": [0, 0, 1]}, {"pos": [2, 2, 0.8], "dir": [0, 0, 1]}]},
        {"identifier": "c", "sensors": [{"pos": [3, 3, 0.8], "dir": [0, 0, 1]}]}]}},
        "orphaned_shades": [{"identifier": "floor",
            "geometry": {"boundary": [[0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0]]}}]})");
    write_text(folder / "w.epw", weather_of_a_day());
    const Finished run =
        run_program({"daylight", folder / "open.hbjson", "--epw", folder / "w.epw", "-o", folder / "year", "--json"});
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_NE(run.out.find("\"sensors\": 3.0"), std::string::npos) << run.out;
    EXPECT_EQ(lines(read_text(folder / "year/honeybee/a_b.ill")), 2u);
    EXPECT_EQ(lines(read_text(folder / "year/honeybee/c.ill")), 1u);
    const std::string hours = read_text(folder / "year/honeybee/sun-up-hours.txt");
    const std::string row = read_text(folder / "year/honeybee/c.ill");
    EXPECT_EQ(lines(hours), static_cast<std::size_t>(std::count(row.begin(), row.end(), ' ')));
    // The weather is that of 21 June, day 172 of the year, and the sun rises after 4 o'clock.
    const double first = std::stod(hours);
    EXPECT_GT(first, 171 * 24 + 3);
    EXPECT_LT(first, 171 * 24 + 8);
    EXPECT_NE(read_text(folder / "year/honeybee/grids_info.json").find("\"full_id\": \"a_b\""), std::string::npos);
    EXPECT_EQ(run_program({"daylight", write_court(folder), "--epw", folder / "w.epw", "-o", folder / "y"}).status, 2);
}

TEST(ProgramDaylight, WritesTablesOfAYear) {
    const TemporaryFolder folder;
    ASSERT_EQ(run_program({"solve", write_court(folder), "-o", folder / "s.h5", "--bounces", "0", "-q", "--sky",
                           "uniform,dhi=100"})
                  .status,
              0);
    write_text(folder / "w.epw", weather_of_a_day());
    write_text(folder / "p.pts", "3 1.5 0.8 0 0 1\n1 1.5 0.8 0 0 1\n");
    const Finished run = run_program({"daylight", folder / "s.h5", "--epw", folder / "w.epw", "--points",
                                      folder / "p.pts", "-o", folder / "year", "--eyes", folder / "p.pts", "--sun-day",
                                      "02-01", "--sun-altitude", "10", "--hours", "csv", "--json"});
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_NE(run.out.find("\"sDA_300_50\": 1.0"), std::string::npos) << run.out;
    EXPECT_EQ(lines(read_text(folder / "year/illuminance.csv")), 25u);
    EXPECT_EQ(lines(read_text(folder / "year/sun.csv")), 25u);
    EXPECT_EQ(lines(read_text(folder / "year/metrics.csv")), 3u);
    EXPECT_EQ(lines(read_text(folder / "year/matrix.csv")), 3u);
    EXPECT_EQ(read_text(folder / "year/summary.csv").find("name,value\nsensors,2\nhours,24\noccupied_hours,10\n"), 0u);
    EXPECT_EQ(read_text(folder / "year/illuminance.csv").find("month,day,hour,E_0,E_1\n6,21,1,0,0\n"), 0u);
    // EN 17037: 12 of the 24 hours are daylight hours, and half of these have more than 750 lx through the open half.
    EXPECT_NE(run.out.find("\"EN17037_daylight_hours\": 12.0"), std::string::npos) << run.out;
    EXPECT_NE(run.out.find("\"EN17037_level\": 3.0"), std::string::npos) << run.out;
    EXPECT_TRUE(first_line_of(read_text(folder / "year/metrics.csv")).ends_with(",electric_hours_high"));
    EXPECT_EQ(lines(read_text(folder / "year/grids.csv")), 2u);
    EXPECT_EQ(lines(read_text(folder / "year/view.csv")), 3u);
    EXPECT_EQ(run_program({"daylight", folder / "s.h5", "--epw", folder / "w.epw", "--points", folder / "p.pts", "-o",
                           folder / "year", "--sun-day", "02-30"})
                  .status,
              2);
    EXPECT_EQ(run_program({"daylight", folder / "s.h5", "--epw", folder / "none.epw", "--points", folder / "p.pts",
                           "-o", folder / "y"})
                  .status,
              3);
    EXPECT_EQ(
        run_program({"daylight", folder / "s.h5", "--epw", folder / "w.epw", "--points", folder / "p.pts"}).status, 2);
}

TEST(ProgramDaylight, PartsGiveTheFilesOfTheWhole) {
    const TemporaryFolder folder;
    write_text(folder / "w.epw", weather_of_a_day());
    std::string points;
    for (int i = 0; i < 11; ++i) points += "3 " + std::to_string(0.2 + 0.2 * i) + " 0.8 0 0 1\n";
    write_text(folder / "p.pts", points);
    std::vector<std::string> words{"daylight", write_court(folder),
                                   "--epw",    folder / "w.epw",
                                   "--points", folder / "p.pts",
                                   "--error",  "0.1",
                                   "-q",       "-o"};
    const auto run = [&](const std::string& output, const std::vector<std::string>& more) {
        std::vector<std::string> all = words;
        all.push_back(folder / output);
        all.insert(all.end(), more.begin(), more.end());
        return run_program(all);
    };
    for (const std::string format : {"h5", "csv", "npy"}) {
        const Finished whole = run("whole", {"--hours", format, "--threads", "1"});
        ASSERT_EQ(whole.status, 0) << whole.err;
        if (format == "h5") {
            EXPECT_EQ(run("parts", {"--merge"}).status, 3) << "no parts";
            for (const std::string part : {"3/3", "1/3"}) {
                const Finished ran = run("parts", {"--part", part, "--threads", "2"});
                ASSERT_EQ(ran.status, 0) << ran.err;
            }
            EXPECT_EQ(run("parts", {"--merge"}).status, 3) << "a part is missing";
            ASSERT_EQ(run("parts", {"--part", "2/3"}).status, 0);
        }
        const Finished merged = run("parts", {"--merge", "--hours", format});
        ASSERT_EQ(merged.status, 0) << merged.err;
        std::size_t files = 0;
        for (const auto& entry : std::filesystem::directory_iterator(folder / "whole")) {
            const std::string name = entry.path().filename().string();
            EXPECT_EQ(read_text(entry.path()), read_text(folder / ("parts/" + name))) << name;
            ++files;
        }
        EXPECT_GE(files, 5u);
    }
    // Parts of other options do not belong to this simulation.
    EXPECT_EQ(run("parts", {"--merge", "--ground", "0.3"}).status, 3);
    for (const std::string part : {"0/3", "4/3", "1", "1/3x"})
        EXPECT_EQ(run("parts", {"--part", part}).status, 2) << part;
}

namespace {

/// Value of a name in summary.csv.
double summary_value(const std::string& folder, const std::string& name) {
    const std::string text = read_text(folder + "/summary.csv");
    const std::size_t at = text.find("\n" + name + ",");
    EXPECT_NE(at, std::string::npos) << name << " in " << text;
    return at == std::string::npos ? -1 : std::stod(text.substr(at + name.size() + 2));
}

}  // namespace

TEST(ProgramDaylight, RadiancesMatricesAreWrittenAndRead) {
    const TemporaryFolder folder;
    const std::string scene = write_court(folder);
    write_text(folder / "w.epw", weather_of_a_day());
    write_text(folder / "p.pts", "3 1.5 0.8 0 0 1\n1 1.5 0.8 0 0 1\n2 1 0.8 0 0 1\n");
    const auto run = [&](const std::string& output, const std::vector<std::string>& more) {
        std::vector<std::string> words{
            "daylight", scene, "--epw", folder / "w.epw", "--points", folder / "p.pts", "--error",
            "0.1",      "-q",  "-o",    folder / output};
        words.insert(words.end(), more.begin(), more.end());
        return run_program(words);
    };
    for (const std::string format : {"ascii", "float", "double"}) {
        ASSERT_EQ(run("ours", {"--matrix", format}).status, 0);
        const std::string matrix = folder / "ours/matrix.mtx";
        EXPECT_EQ(read_text(matrix).find("#?RADIANCE\nexitance daylight\nNROWS=3\nNCOLS=146\nNCOMP=3\n"), 0u);
        const Finished read = run("theirs", {"--coefficients", matrix, "--json"});
        ASSERT_EQ(read.status, 0) << read.err;
        EXPECT_NE(read.out.find("\"error_lux_hours\": null"), std::string::npos) << read.out;
        // Daylight factors depend on the coefficients alone, which ascii rounds to seven digits.
        const double factor = summary_value(folder / "ours", "mean_daylight_factor");
        EXPECT_NEAR(summary_value(folder / "theirs", "mean_daylight_factor"), factor, 1e-5 * factor);
    }
    EXPECT_EQ(run("theirs", {"--coefficients", folder / "ours/matrix.mtx", "--sky-patches", "577"}).status, 3);
    ASSERT_EQ(run("ours", {"--matrix", "ascii"}).status, 0);
    const std::string good = read_text(folder / "ours/matrix.mtx");
    const std::size_t first = good.find_first_not_of("\n", good.find("\n\n")), end = good.find_first_of(" \t", first);
    for (const std::string number : {"nan", "-5", "inf"}) {
        write_text(folder / "bad.mtx", good.substr(0, first) + number + good.substr(end));
        const Finished refused = run("theirs", {"--coefficients", folder / "bad.mtx"});
        EXPECT_EQ(refused.status, 3) << number;
        EXPECT_NE(refused.err.find("in row 1, column 1"), std::string::npos) << refused.err;
    }
    EXPECT_EQ(run("theirs", {"--coefficients", folder / "ours/matrix.mtx", "--part", "1/2"}).status, 2);
}

TEST(ProgramDaylight, WeaFilesOccupancyAndThresholds) {
    const TemporaryFolder folder;
    const std::string scene = write_court(folder);
    write_text(folder / "w.epw", weather_of_a_day());
    write_text(folder / "p.pts", "3 1.5 0.8 0 0 1\n1 1.5 0.8 0 0 1\n");
    std::string wea =
                    "place Town\nlatitude 47\nlongitude -8\ntime_zone -15\nsite_elevation 400\n"
                    "weather_data_file_units 1\n",
                occupied;
    for (int h = 0; h < 24; ++h) {
        wea += "6 21 " + std::to_string(h) + ".5 " + (h > 6 && h < 19 ? "500 120" : "0 0") + "\n";
        occupied += h == 11 || h == 12 ? "1\n" : "0\n";
    }
    write_text(folder / "w.wea", wea), write_text(folder / "noon.csv", occupied);
    const auto run = [&](const std::string& output, const std::vector<std::string>& more) {
        std::vector<std::string> words{
            "daylight", scene, "--epw", folder / "w.wea", "--points", folder / "p.pts", "--error",
            "0.1",      "-q",  "-o",    folder / output};
        words.insert(words.end(), more.begin(), more.end());
        return run_program(words).status;
    };
    ASSERT_EQ(run("a", {}), 0);
    EXPECT_EQ(summary_value(folder / "a", "occupied_hours"), 10);
    ASSERT_EQ(run("b", {"--occupied", folder / "noon.csv", "--target", "500", "--useful", "50,500,2000",
                        "--dimmed-power", "0.25"}),
              0);
    EXPECT_EQ(summary_value(folder / "b", "occupied_hours"), 2);
    EXPECT_EQ(summary_value(folder / "b", "sDA_500_50"), 1);
    EXPECT_EQ(summary_value(folder / "b", "mean_cDA_500"), 1);
    EXPECT_EQ(summary_value(folder / "b", "mean_electric_hours"), 0.5);  // two hours at a quarter of the power
    EXPECT_NE(first_line_of(read_text(folder / "b/metrics.csv")).find(",DA_500,UDI_below_50,UDI_50_500,UDI_500_2000,"),
              std::string::npos);
    ASSERT_EQ(run("c", {"--occupied", "11-13"}), 0);
    EXPECT_EQ(summary_value(folder / "c", "occupied_hours"), 2);
    ASSERT_EQ(run("d", {"--occupied", "13-11"}), 0);  // over midnight
    EXPECT_EQ(summary_value(folder / "d", "occupied_hours"), 22);
    EXPECT_EQ(run("e", {"--occupied", "13-13"}), 2);
    for (const std::string number : {"0\n", "nan\n", "-1\n"}) {
        std::string hours;
        for (int h = 0; h < 24; ++h) hours += number;
        write_text(folder / "hours.csv", hours);
        EXPECT_EQ(run("e", {"--occupied", folder / "hours.csv"}), 3) << number;
    }
    write_text(folder / "noon.csv", "1\n0\n");
    EXPECT_EQ(run("d", {"--occupied", folder / "noon.csv"}), 3);
    EXPECT_EQ(run("d", {"--useful", "300,100,3000"}), 2);
}

/// The scripts of examples/cluster for parts, in a folder with a scene, its weather and its sensors.
class DaylightScripts : public testing::Test {
  protected:
    DaylightScripts() {
        write_court(folder_);
        write_text(folder_ / "w.epw", weather_of_a_day());
        write_text(folder_ / "p.pts", "3 1.5 0.8 0 0 1\n1 1.5 0.8 0 0 1\n2 1 0.8 0 0 1\n");
        EXPECT_EQ(shell("exitance daylight " + options("whole")).status, 0);
    }
    static std::string options(const std::string& output) {
        return "court.obj --epw w.epw --points p.pts --error 0.1 -o " + output;
    }
    Finished shell(const std::string& command) {
        const std::string path = std::filesystem::path(program()).parent_path().string();
        return RunningProgram({"-c", "PATH='" + path + "':$PATH; cd '" + (folder_ / "") + "' && " + command}, {},
                              "/bin/bash")
            .finish();
    }
    static std::string script(const std::string& name) {
        return "'" + source_folder() + "/examples/cluster/" + name + "' ";
    }
    void expect_whole() {
        for (const std::string name : {"hours.h5", "metrics.csv", "summary.csv"})
            EXPECT_EQ(read_text(folder_ / ("parts/" + name)), read_text(folder_ / ("whole/" + name))) << name;
    }
    TemporaryFolder folder_;
};

/// Slurm's array tasks, with the variables that Slurm sets, as plain processes.
TEST_F(DaylightScripts, SlurmArrayTasksRunTheirParts) {
    for (const std::string task : {"1", "2"}) {
        const Finished run = shell("SLURM_ARRAY_TASK_ID=" + task + " SLURM_CPUS_PER_TASK=1 bash " +
                                   script("daylight_array.sh") + "2 " + options("parts"));
        EXPECT_EQ(run.status, 0) << run.out << run.err;
    }
    EXPECT_EQ(shell("exitance daylight --merge " + options("parts")).status, 0);
    expect_whole();
}

TEST_F(DaylightScripts, DaskRunsAllPartsOnTwoWorkers) {
    if (shell("/usr/bin/python3 -c 'import dask.distributed'").status != 0)
        GTEST_SKIP() << "dask.distributed is not installed: apt-get install python3-distributed";
    const Finished run = shell("/usr/bin/python3 " + script("dask_daylight.py") + "2 " + options("parts"));
    EXPECT_EQ(run.status, 0) << run.out << run.err;
    expect_whole();
}

}  // namespace exitance::test
