#include "exitance/sweep/input_hashes.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <set>
#include <string_view>

#include "exitance/base/words.hpp"
#include "exitance/io/files/sha256.hpp"
#include "exitance/io/files/whole_file.hpp"

namespace exitance {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_name_bytes = 255;  ///< Longest name of a file.

/// True for text that may be the name of a file: it has an ending and does not begin like a number.
bool may_be_name(std::string_view text) {
    if (text.size() < 3 || text.size() > max_name_bytes) return false;
    const unsigned char first = static_cast<unsigned char>(text.front());
    if (first == '-' || first == '+') return false;
    const std::size_t dot = text.find_last_of('.');
    if (dot == std::string_view::npos || dot + 1 >= text.size()) return false;
    const auto is_letter = [](unsigned char c) { return std::isalpha(c) != 0; };
    // "1e-3.5" is a number, not a name; "3rd.mtl" is a name
    return is_letter(first) || std::any_of(text.begin() + static_cast<std::ptrdiff_t>(dot), text.end(), is_letter);
}

/// Calls `use` for the parts of `text` between any of the characters in `limits`.
template <class Use>
void for_each_part(std::string_view text, std::string_view limits, const Use& use) {
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find_first_of(limits, at), text.size());
        if (end > at) use(text.substr(at, end - at));
        at = end + 1;
    }
}

/// Texts in a file that may be names of files: words, texts in quotes, and the rest of a line after its first word.
std::set<std::string, std::less<>> names_in(std::string_view content) {
    std::set<std::string, std::less<>> names;
    if (content.find('\0') != std::string_view::npos) return names;
    const auto add = [&](std::string_view text) {
        if (may_be_name(text)) names.emplace(text);
    };
    for_each_part(content, "\n", [&](std::string_view line) {
        if (line.find('.') == std::string_view::npos) return;
        for_each_part(line, " \t\r\",;=()[]{}<>", add);
        if (line.find('"') != std::string_view::npos) for_each_part(line, "\"", add);
        const std::string_view whole = without_blanks(line);
        const std::size_t blank = whole.find_first_of(" \t");
        if (blank != std::string_view::npos && whole.size() <= max_name_bytes) add(without_blanks(whole.substr(blank)));
    });
    return names;
}

bool is_plain_file(const fs::path& path) {
    std::error_code ignored;
    return fs::is_regular_file(path, ignored);
}

}  // namespace

Result<std::vector<std::string>> files_named_by(const std::string& path) {
    std::vector<std::string> files{path};
    std::set<std::string> known{fs::path(path).lexically_normal().string()};
    for (std::size_t i = 0; i < files.size(); ++i) {
        const Result<std::string> content = read_whole_file(files[i]);
        if (!content) return content.error();
        const std::string from = files[i];
        for (const std::string& name : names_in(*content)) {
            const fs::path file = (fs::path(from).parent_path() / name).lexically_normal();
            if (is_plain_file(file) && known.insert(file.string()).second) files.push_back(file.string());
        }
    }
    return files;
}

Result<std::string> InputHashes::of(const std::string& path) {
    const auto [at, is_new] = known_.try_emplace(path);
    if (!is_new || !is_plain_file(path)) return at->second;
    const Result<std::vector<std::string>> files = files_named_by(path);
    if (!files) return files.error();
    Sha256 hash;
    for (const std::string& file : *files) {
        const Result<std::string> content = read_whole_file(file);
        if (!content) return content.error();
        hash.add_text(fs::path(file).lexically_relative(fs::path(path).parent_path()).string());
        hash.add_text(*content);
    }
    return at->second = hash.finish();
}

Result<std::vector<HashedFile>> InputHashes::of_word(const std::string& word, const std::string& base) {
    std::vector<std::string> names{word};
    std::vector<HashedFile> out;
    if (word.find_first_of("=,; ") != std::string::npos)
        for_each_part(word, "=,; ", [&](std::string_view part) { names.emplace_back(part); });
    for (const std::string& name : names) {
        const std::string path = (fs::path(base) / name).string();
        const Result<std::string> hash = of(path);
        if (!hash) return hash.error();
        if (!hash->empty()) out.push_back({path, *hash});
    }
    return out;
}

}  // namespace exitance
