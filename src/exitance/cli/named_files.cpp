#include "exitance/cli/named_files.hpp"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <string_view>
#include <utility>

#include "exitance/io/files/whole_file.hpp"

namespace exitance {
namespace {

/// True if an output and another named file are the same file. A name that does not exist yet is only compared with
/// outputs: values of other options may be words that look like file names.
bool is_one_file(const NamedFile& output, const NamedFile& other) {
    std::error_code failed;
    if (std::filesystem::is_regular_file(output.path, failed)) return is_same_file(output.path, other.path);
    const auto normal = [](const NamedFile& file) { return std::filesystem::path(file.path).lexically_normal(); };
    return other.is_output && !std::filesystem::exists(output.path, failed) && normal(output) == normal(other);
}

}  // namespace

Result<void> check_named_files(std::span<const NamedFile> files) {
    for (const NamedFile& output : files)
        for (const NamedFile& other : files)
            if (output.is_output && &output != &other && is_one_file(output, other))
                return Error{ErrorCode::usage,
                             fmt::format("{}{}", other.is_output ? "is also the output of " : "is also the input of ",
                                         other.option),
                             output.path, fmt::format("choose another name for {}", output.option)};
    return {};
}

Result<void> check_solution_name(const std::string& verb, const std::string& path) {
    const std::string end = ending(path);
    if (path == "-")
        return Error{ErrorCode::usage, "solutions are not written to standard output", "-o", "name a file: -o S.h5"};
    if (end.empty() || end == ".h5") return {};
    constexpr std::array<std::pair<std::string_view, std::string_view>, 10> made_by{{{".png", "render"},
                                                                                     {".exr", "render"},
                                                                                     {".hdr", "render"},
                                                                                     {".vtu", "export"},
                                                                                     {".vtkhdf", "export"},
                                                                                     {".hdf", "export"},
                                                                                     {".glb", "export"},
                                                                                     {".gltf", "export"},
                                                                                     {".obj", "export"},
                                                                                     {".csv", "export"}}};
    for (const auto& [known, maker] : made_by)
        if (known == end)
            return Error{ErrorCode::usage,
                         fmt::format("{} writes a solution (.h5), from which `{}` makes a {}", verb, maker, end), "-o",
                         fmt::format("write S.h5, then exitance {} S.h5 -o {}", maker, path)};
    return Error{ErrorCode::usage, fmt::format("{} writes a solution (.h5), not a {}", verb, end), "-o",
                 "choose a name that ends in .h5"};
}

Result<void> check_scene_is_kept(const std::string& output, const std::string& scene_file) {
    if (scene_file.empty() || !is_same_file(output, scene_file)) return {};
    return Error{ErrorCode::usage, "is the scene of this solution", output, "choose another name or folder"};
}

}  // namespace exitance
