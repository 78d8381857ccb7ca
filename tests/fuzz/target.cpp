#include "fuzz/target.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "support/places.hpp"
#include "support/temporary_folder.hpp"

namespace exitance::fuzz {
namespace {

/// Uses memory if possible: a disk would be slow for thousands of small files per second.
std::filesystem::path folder_in_memory() {
    constexpr const char* shared_memory = "/dev/shm";
    return ::access(shared_memory, W_OK | X_OK) == 0 ? shared_memory : std::filesystem::temp_directory_path();
}

}  // namespace

const Target* find_target(std::string_view name) {
    const auto all = targets();
    const auto found = std::find_if(all.begin(), all.end(), [&](const Target& t) { return t.name == name; });
    return found == all.end() ? nullptr : &*found;
}

std::vector<std::string> corpus_folder(std::string_view name) {
    namespace fs = std::filesystem;
    std::vector<fs::path> paths;
    std::error_code ignored;
    for (const auto& entry :
         fs::directory_iterator(fs::path(test::source_folder() + "/tests/fuzz/corpus") / name, ignored))
        paths.push_back(entry.path());
    std::sort(paths.begin(), paths.end());
    std::vector<std::string> out;
    for (const fs::path& path : paths) {
        std::ifstream in(path, std::ios::binary);
        out.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
    }
    return out;
}

std::string file_with(const std::string& bytes, const std::string& name) {
    static const TemporaryFolder folder(folder_in_memory());
    const std::string path = folder / name;
    ::unlink(path.c_str());  // a process that has the previous file open keeps it
    const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL, 0600);
    if (file < 0 || ::write(file, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size())) std::abort();
    ::close(file);
    return path;
}

}  // namespace exitance::fuzz
