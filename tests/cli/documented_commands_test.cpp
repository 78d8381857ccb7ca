#include <gtest/gtest.h>

#include <algorithm>
#include <regex>
#include <sstream>

#include "cli/input_files.hpp"
#include "run_program.hpp"
#include "support/places.hpp"

namespace exitance::test {
namespace {

namespace fs = std::filesystem;

const fs::path root = test::source_folder();

/// Pages with commands. The guides in docs/tutorials have a test of their own.
std::vector<std::string> pages() {
    std::vector<std::string> out{"README.md"};
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / "docs")) {
        const std::string page = fs::relative(entry.path(), root);
        if (page.ends_with(".md") && !page.starts_with("docs/tutorials/") && page != "docs/options.md")
            out.push_back(page);
    }
    std::sort(out.begin(), out.end());
    return out;
}

/// Blocks of a page that are indented by four spaces, blank lines included, or fenced as `sh`, in the order of the
/// page.
std::vector<std::string> blocks_of(const std::string& text) {
    std::vector<std::string> out;
    std::istringstream lines(text);
    std::string block, fence;
    const auto close = [&] {
        while (block.ends_with("\n\n")) block.pop_back();
        if (!block.empty()) out.push_back(block);
        block.clear();
    };
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("```")) {
            close();
            fence = fence.empty() ? line.substr(3) + "`" : "";
        } else if (fence == "sh`") {
            block += line + "\n";
        } else if (fence.empty() && line.starts_with("    ")) {
            block += line.substr(4) + "\n";
        } else if (fence.empty() && line.empty() && !block.empty()) {
            block += "\n";
        } else {
            close();
        }
    }
    close();
    return out;
}

/// True for blocks that consist of the program's commands. Blocks that start other programs (mpirun, the installation)
/// have tests of their own.
bool is_runnable(const std::string& block) {
    static const std::regex own(R"((^|\n)exitance [a-z])"), other(R"((^|\n)(mpirun|srun|sbatch|\./|#SBATCH|#!))");
    static const std::regex placeholder(R"(\$SLURM|--method ambient)");
    return std::regex_search(block, own) && !std::regex_search(block, other) && !std::regex_search(block, placeholder);
}

/// Coarser versions of the same commands, which run in less time.
std::string made_quick(std::string commands) {
    const std::vector<std::pair<std::string, std::string>> coarser{
        {"--error(-interpolant)? 0\\.[0-9]+", "--error$1 0.5"},
        {"--density [0-9]+", "--density 2"},
        {"--reference [0-9]+", "--reference 16"},
        {"--max-units [0-9]+", "--max-units 16"},
        {"complex m=[0-9]+", "complex m=1"},
        {"--mesh-size 0\\.[0-9]+", "--mesh-size 1"}};
    for (const auto& [fine, coarse] : coarser) commands = std::regex_replace(commands, std::regex(fine), coarse);
    return commands;
}

/// Calls the program for a quick form of a command: coarse solves, small pictures and maps, a viewer that ends, studies
/// that are only read.
constexpr const char* stand_in = R"(#!/bin/bash
case "$1" in
solve)
    [[ " $* " == *" --error "* || " $* " == *" --recipe "* ]] || set -- "$@" --error 0.5
    "$PROGRAM" "$@" -q; status=$?
    [[ $status -eq 4 ]] && status=0
    exit $status ;;
render | report)
    [[ " $* " == *" --size "* || " $* " != *" -o "* ]] || set -- "$@" --size 48x30
    exec "$PROGRAM" "$@" -q ;;
view)
    timeout --signal INT 1 "$PROGRAM" "$@" --progress none -q
    status=$?
    [[ $status -eq 124 || $status -eq 130 || ($status -eq 0 && " $* " == *" -o "*) ]] ;;
bake)
    [[ " $* " == *" --density "* || " $* " == *" --uv "* ]] || set -- "$@" --density 2
    exec "$PROGRAM" "$@" -q ;;
experiment)
    [[ "$2" == list ]] && exec "$PROGRAM" "$@"
    exec "$PROGRAM" experiment "$2" --print ;;
*) exec "$PROGRAM" "$@" ;;
esac
)";

/// The files that commands of the pages read, made by the program itself or written here.
void write_inputs(const TemporaryFolder& folder) {
    write_text(folder / "downlight.ies", downlight);
    write_text(folder / "lights.csv", "file,x,y,z\ndownlight.ies,1.2,1.5,2.7\n");
    write_text(folder / "city.epw", weather_of_a_day());
    write_text(folder / "office.hbjson", R"({"type": "Model", "properties": {"radiance": {"sensor_grids": [
        {"identifier": "desk", "sensors": [{"pos": [1, 1, 0.8], "dir": [0, 0, 1]}]}]}},
        "orphaned_shades": [{"identifier": "floor",
            "geometry": {"boundary": [[0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0]]}}]})");
    write_text(folder / "desks.pts", "1 1 0.75 0 0 1\n2 1 0.75 0 0 1\n");
    write_text(folder / "desks.csv", "x,y,z,nx,ny,nz\n1,1,0.75,0,0,1\n2,1,0.75,0,0,1\n");
    write_text(folder / "seats.csv", "x,y,z,dx,dy,dz\n1,1,1.2,0,1,0\n");
    // A picture of 32 x 16 grey pixels: three mantissas and the exponent of each.
    std::string grey = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 16 +X 32\n";
    for (int i = 0; i < 32 * 16; ++i) grey += "\x40\x40\x40\x84";
    write_text(folder / "harbour.hdr", grey);
    write_text(folder / "path.csv", "time,ex,ey,ez,tx,ty,tz,fov\n0,1,1,1.6,3,2,1,60\n0.1,1.1,1,1.6,3,2,1,60\n");
    const std::vector<std::vector<std::string>> scenes{{"room", "office", "nx=1", "ny=1"},
                                                       {"office", "office", "nx=1", "ny=1", "nfurn=2"},
                                                       {"blocker", "blocker"},
                                                       {"boxes", "boxes"},
                                                       {"gcr1", "gcr1"}};
    for (const std::vector<std::string>& scene : scenes) {
        std::vector<std::string> words{"generate"};
        words.insert(words.end(), scene.begin() + 1, scene.end());
        words.insert(words.end(), {"-o", folder / (scene[0] + ".obj")});
        const Finished made = run_program(words);
        ASSERT_EQ(made.status, 0) << made.err;
    }
    const Finished solved = run_program({"solve", folder / "room.obj", "-o", folder / "room.h5", "--error", "0.5"});
    ASSERT_EQ(solved.status, 0) << solved.err;
    for (const char* copy : {"before.h5", "after.h5"}) fs::copy_file(folder / "room.h5", folder / copy);
}

}  // namespace

TEST(DocumentedCommands, RunAsWritten) {
    const TemporaryFolder inputs;  // commands change their copies only
    ASSERT_NO_FATAL_FAILURE(write_inputs(inputs));
    std::size_t count = 0;
    for (const std::string& page : pages()) {
        const std::vector<std::string> blocks = blocks_of(read_text(root / page));
        std::string commands;
        for (const std::string& block : blocks)
            if (is_runnable(block)) commands += block, ++count;
        if (commands.empty()) continue;
        const TemporaryFolder folder;
        fs::copy(inputs / "", folder / "", fs::copy_options::recursive);
        for (const std::string& block : blocks)
            if (block.starts_with("title = ")) write_text(folder / "mine.toml", block);
        fs::create_directory(folder / "bin");
        write_text(folder / "bin/exitance", stand_in);
        fs::permissions(folder / "bin/exitance", fs::perms::owner_all);
        write_text(folder / "run.sh", "set -eo pipefail\ncd '" + (folder / "") + "'\nexport PROGRAM='" +
                                          test::program() + "'\nPATH=$PWD/bin:$PATH\n" + made_quick(commands) +
                                          "\necho the end\n");
        const Finished run = RunningProgram({folder / "run.sh"}, {}, "/bin/bash").finish();
        EXPECT_EQ(run.status, 0) << page << '\n' << commands << run.out << run.err;
        EXPECT_TRUE(run.out.ends_with("the end\n")) << page << '\n' << run.out << run.err;
    }
    EXPECT_GT(count, 25u);
}

TEST(DocumentedCommands, BlocksAreFound) {
    EXPECT_EQ(blocks_of("Text\n\n    exitance a\n    exitance b\n\n```sh\nexitance c\n```\n\n```cpp\nint d;\n```\n"),
              (std::vector<std::string>{"exitance a\nexitance b\n", "exitance c\n"}));
    EXPECT_TRUE(is_runnable("exitance solve room.obj -o room.h5\n"));
    EXPECT_FALSE(is_runnable("mpirun -n 4 exitance solve room.obj -o room.h5\n"));
    EXPECT_FALSE(is_runnable("E = F B\n"));
}

}  // namespace exitance::test
