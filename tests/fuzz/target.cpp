#include "fuzz/target.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "support/temporary_folder.hpp"

namespace exitance::fuzz {

const Target* find_target(std::string_view name) {
    const auto all = targets();
    const auto found = std::find_if(all.begin(), all.end(), [&](const Target& t) { return t.name == name; });
    return found == all.end() ? nullptr : &*found;
}

std::vector<std::string> corpus_folder(std::string_view name) {
    namespace fs = std::filesystem;
    std::vector<fs::path> paths;
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(fs::path(EXITANCE_SOURCE_DIR "/tests/fuzz/corpus") / name, ignored))
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
    static const TemporaryFolder folder;
    const std::string path = folder / name;
    std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    return path;
}

}  // namespace exitance::fuzz
