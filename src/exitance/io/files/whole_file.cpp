#include "exitance/io/files/whole_file.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

namespace exitance {
namespace {

Error cannot_read(const std::string& path, const char* what, int reason) {
    return {ErrorCode::cannot_read, std::string(what) + ": " + std::strerror(reason), path, ""};
}

}  // namespace

Result<std::string> read_whole_file(const std::string& path) {
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored)) return cannot_read(path, "cannot be read", EISDIR);
    // A device has no end: a scene that names /dev/zero as its material file must not hang the program.
    const auto type = std::filesystem::status(path, ignored).type();
    if (type == std::filesystem::file_type::character || type == std::filesystem::file_type::block)
        return cannot_read(path, "cannot be read", ENODEV);
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
    if (!file) return cannot_read(path, "cannot be opened", errno);
    std::string content;
    if (const auto size = std::filesystem::file_size(path, ignored); !ignored) content.reserve(size);
    char block[1 << 16];
    for (std::size_t n; (n = std::fread(block, 1, sizeof block, file.get())) > 0;) content.append(block, n);
    if (std::ferror(file.get())) return cannot_read(path, "cannot be read", errno);
    return content;
}

std::string beside(const std::string& path, std::string_view name) {
    return (std::filesystem::path(path).parent_path() / std::filesystem::path(name)).string();
}

std::string found_beside(const std::string& path, std::string_view name) {
    namespace fs = std::filesystem;
    std::error_code ignored;
    const std::string as_said = beside(path, name);
    if (fs::is_regular_file(as_said, ignored)) return as_said;
    // The name may come from another system: with backslashes, unknown folders, or different capitals.
    std::string slashed(name);
    std::replace(slashed.begin(), slashed.end(), '\\', '/');
    const auto small = [](std::string text) {
        for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        return text;
    };
    const fs::path last = fs::path(slashed).filename();
    for (const std::string& folder : {fs::path(beside(path, slashed)).parent_path().string(), beside(path, "")}) {
        std::string best;
        for (const fs::directory_entry& entry : fs::directory_iterator(folder.empty() ? "." : folder, ignored)) {
            const std::string here = entry.path().filename().string();
            if (small(here) == small(last.string()) && (best.empty() || entry.path().string() < best))
                best = entry.path().string();
        }
        if (!best.empty()) return best;
    }
    return as_said;
}

bool is_same_file(const std::string& a, const std::string& b) {
    std::error_code failed;
    return std::filesystem::equivalent(a, b, failed) && !failed;
}

std::string ending(const std::string& path) {
    std::string out = std::filesystem::path(path).extension().string();
    std::transform(out.begin(), out.end(), out.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return out;
}

}  // namespace exitance
