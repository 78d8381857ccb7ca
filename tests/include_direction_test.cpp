#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <string>
#include <vector>
#include "support/places.hpp"

namespace exitance {
namespace {

namespace fs = std::filesystem;

/// Folders in the order of dependency: each may include itself, its subfolders and the folders before it. Nothing but
/// the program includes the laboratory. `api` implements the public headers, include/exitance, and alone includes them.
const std::vector<std::string> order{"base",       "calibration",  "scene",   "samples", "processes", "form_factors",
                                     "visibility", "shadow_lines", "mesh",    "basis",   "direct",    "transport",
                                     "links",      "solution",     "solve",   "gather",  "evaluate",  "discontinuity",
                                     "error",      "reference",    "measure", "methods", "what_if",   "view_factors",
                                     "io",         "sweep",        "api",     "lab",     "cli"};

/// The files that may include a third-party library, which is identified by the first folder or the name of its
/// headers.
struct Door {
    std::string library;
    std::regex header;
    std::set<std::string> files;
};
const std::vector<Door> doors{
    {"Embree", std::regex("embree[34]/.*"), {"visibility/embree_rays.cpp"}},
    {"CGAL", std::regex("CGAL/.*"), {"mesh/planar_subdivision.cpp"}},
    {"oneTBB", std::regex("(tbb|oneapi)/.*"), {"base/parallel.cpp"}},
    {"HDF5",
     std::regex("hdf5.*|H5.*"),
     {"io/solution/hdf5_library.cpp", "io/solution/hdf5_reader.cpp", "io/solution/hdf5_rehearsal.cpp",
      "io/solution/hdf5_output.cpp", "io/solution/hdf5_writer.cpp", "io/solution/hdf5_chunks.cpp"}},
    {"zlib", std::regex("zlib\\.h"), {"io/solution/hdf5_chunks.cpp"}},
    {"libpng", std::regex("png\\.h"), {"io/pictures/png.cpp"}},
    {"FreeType", std::regex("ft2build\\.h"), {"io/pictures/text.cpp"}},
    {"libjpeg", std::regex("jpeglib\\.h"), {"io/scenes/textures/jpeg_mean.cpp"}},
    {"tinygltf", std::regex("tiny_gltf\\.h"), {"io/scenes/gltf/gltf_values.hpp", "io/scenes/gltf/gltf_parse.cpp"}},
    {"OpenEXR", std::regex("OpenEXR/.*|Imf.*"), {"io/pictures/exr.cpp", "io/pictures/read_exr.cpp"}},
    {"CLI11", std::regex("CLI/.*"), {"cli/options/option_kinds.hpp"}},
    {"cpp-httplib", std::regex("httplib\\.h"), {"cli/view/view_server.cpp"}},
    {"MPI", std::regex("mpi\\.h"), {"processes/team.hpp"}},
    {"PETSc", std::regex("petsc.*"), {"solve/petsc.cpp"}},
    {"nlohmann-json",
     std::regex("nlohmann/.*"),
     {"cli/json_output.cpp", "cli/view/view_share.cpp", "lab/study/run_facts.cpp", "io/export/viewer_data.cpp",
      "io/report/honeybee_results.cpp", "io/scenes/json_members.hpp", "io/solution/statistics_json.cpp",
      "sweep/sweep_json.cpp"}},
    {"toml++", std::regex("toml\\+\\+/.*"), {"io/files/toml_keys.hpp"}},
};

struct Include {
    std::string file;  ///< Path below src/exitance.
    int line;
    std::string header;
    std::string place() const { return file + ":" + std::to_string(line) + ": " + header; }
};

std::vector<Include> read_includes(const fs::path& root, const fs::path& path) {
    static const std::regex pattern(R"re(^\s*#\s*include\s*["<]([^">]+)[">])re");
    std::vector<Include> found;
    std::ifstream in(path);
    std::string line;
    std::smatch match;
    for (int number = 1; std::getline(in, line); ++number)
        if (std::regex_search(line, match, pattern)) found.push_back({fs::relative(path, root), number, match[1]});
    return found;
}

/// Every #include of the library and the program, except those of unit tests, which may include anything.
const std::vector<Include>& all_includes() {
    static const std::vector<Include> includes = [] {
        const fs::path root = fs::path(test::source_folder()) / "src/exitance";
        std::vector<Include> all;
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root)) {
            const std::string name = entry.path().filename();
            const bool is_code = name.ends_with(".cpp") || name.ends_with(".hpp");
            if (!is_code || name.ends_with("_test.cpp")) continue;
            for (Include& include : read_includes(root, entry.path())) all.push_back(std::move(include));
        }
        return all;
    }();
    return includes;
}

std::optional<std::size_t> rank(const std::string& folder) {
    const auto at = std::find(order.begin(), order.end(), folder);
    if (at == order.end()) return std::nullopt;
    return static_cast<std::size_t>(at - order.begin());
}

std::string first_folder(const std::string& path) {
    return path.substr(0, path.find('/'));
}

/// True for the public headers, "exitance/scene.hpp", which are in no folder of the engine.
bool is_public(const std::string& header) {
    static const std::regex pattern("exitance/[a-z_]+\\.hpp");
    return std::regex_match(header, pattern);
}

}  // namespace

TEST(Includes, FoldersIncludeOnlyThoseBeforeThem) {
    const std::string own = "exitance/";
    for (const Include& include : all_includes()) {
        const std::optional<std::size_t> from = rank(first_folder(include.file));
        ASSERT_TRUE(from) << include.file << " stands in a folder without a place in the order";
        if (!include.header.starts_with(own)) continue;
        if (is_public(include.header)) {
            EXPECT_EQ(first_folder(include.file), "api") << include.place();
            continue;
        }
        const std::optional<std::size_t> to = rank(first_folder(include.header.substr(own.size())));
        ASSERT_TRUE(to) << include.place();
        EXPECT_LE(*to, *from) << include.place() << ": an arrow pointing back";
    }
}

TEST(Includes, OnlyListedFilesIncludeALibrary) {
    for (const Include& include : all_includes())
        for (const Door& door : doors)
            if (std::regex_match(include.header, door.header)) {
                EXPECT_TRUE(door.files.contains(include.file))
                    << include.place() << ": " << door.library << "'s door is " << *door.files.begin();
            }
}

/// Headers only include the standard library and the project, except the program's own kinds of options and the readers
/// of TOML, which only .cpp files include.
TEST(Includes, HeadersIncludeNoThirdPartyLibrary) {
    const std::set<std::string> exceptions{"cli/options/option_kinds.hpp", "io/files/toml_keys.hpp",
                                           "io/scenes/gltf/gltf_values.hpp", "io/scenes/json_members.hpp"};
    const std::regex third_party("(embree[34]|CGAL|tbb|oneapi|CLI|nlohmann|fmt)/.*|hdf5.*|H5.*|png\\.h|tiny_gltf\\.h");
    for (const Include& include : all_includes()) {
        if (include.file.ends_with(".hpp") && !exceptions.contains(include.file)) {
            EXPECT_FALSE(std::regex_match(include.header, third_party)) << include.place();
        }
    }
}

/// The public headers are installed alone, so that they need only the standard library and each other.
TEST(Includes, PublicHeadersIncludeOnlyTheStandardLibraryAndEachOther) {
    const fs::path root = fs::path(test::source_folder()) / "include/exitance";
    const std::regex standard("[a-z_]+");
    std::size_t headers = 0;
    for (const fs::directory_entry& entry : fs::directory_iterator(root)) {
        ++headers;
        for (const Include& include : read_includes(root, entry.path()))
            EXPECT_TRUE(std::regex_match(include.header, standard) ||
                        (is_public(include.header) && fs::exists(root.parent_path() / include.header)))
                << include.place();
    }
    EXPECT_GE(headers, 12u);
}

/// If two types in one program have the same name, the linker keeps only one version of their inline code.
TEST(Headers, DefineEveryTypeOnce) {
    const fs::path root = fs::path(test::source_folder()) / "src/exitance";
    const std::regex definition(
        R"(^(?:template <.*> )?(?:struct|class|enum class) (?:alignas\(\w+\) )?(\w+)(?: final)?(?: : [^;]*)? \{.*)");
    std::map<std::string, std::string> file_of;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root)) {
        if (entry.path().extension() != ".hpp") continue;
        std::ifstream in(entry.path());
        std::smatch match;
        for (std::string line; std::getline(in, line);)
            if (std::regex_match(line, match, definition)) {
                const auto [at, is_new] = file_of.try_emplace(match[1], fs::relative(entry.path(), root));
                EXPECT_TRUE(is_new) << match[1] << " in " << at->second << " and " << entry.path();
            }
    }
    EXPECT_GT(file_of.size(), 300u);
}

TEST(Includes, EveryHeaderIsGuardedAndEveryFileIsRead) {
    const fs::path root = fs::path(test::source_folder()) / "src/exitance";
    std::size_t headers = 0;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root)) {
        if (entry.path().extension() != ".hpp") continue;
        std::ifstream in(entry.path());
        std::string line;
        while (std::getline(in, line) && (line.empty() || line.starts_with("//"))) {
        }
        EXPECT_EQ(line, "#pragma once") << entry.path();
        ++headers;
    }
    EXPECT_GT(headers, 5u);
    EXPECT_GT(all_includes().size(), headers);
}

}  // namespace exitance
