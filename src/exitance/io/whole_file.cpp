#include "exitance/io/whole_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

namespace exitance {
namespace {

Error cannot(ErrorCode code, const std::string& path, const char* what, int reason) {
    return {code, std::string(what) + ": " + std::strerror(reason), path, ""};
}

}  // namespace

Result<std::string> read_whole_file(const std::string& path) {
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored))
        return cannot(ErrorCode::cannot_read, path, "cannot be read", EISDIR);
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
    if (!file) return cannot(ErrorCode::cannot_read, path, "cannot be opened", errno);
    std::string content;
    if (const auto size = std::filesystem::file_size(path, ignored); !ignored) content.reserve(size);
    char block[1 << 16];
    for (std::size_t n; (n = std::fread(block, 1, sizeof block, file.get())) > 0;) content.append(block, n);
    if (std::ferror(file.get())) return cannot(ErrorCode::cannot_read, path, "cannot be read", errno);
    return content;
}

Result<void> write_whole_file(const std::string& path, std::string_view content) {
    const std::string beside = path + ".part" + std::to_string(getpid());
    const int file = ::open(beside.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
    if (file < 0) return cannot(ErrorCode::cannot_write, path, "cannot be written", errno);
    int reason = 0;
    while (!content.empty() && reason == 0) {
        const ssize_t n = ::write(file, content.data(), content.size());
        if (n >= 0)
            content.remove_prefix(static_cast<std::size_t>(n));
        else if (errno != EINTR)
            reason = errno;
    }
    if (reason == 0 && ::fsync(file) != 0 && errno != EINVAL) reason = errno;
    if (::close(file) != 0 && reason == 0) reason = errno;
    if (reason == 0 && std::rename(beside.c_str(), path.c_str()) != 0) reason = errno;
    if (reason == 0) return {};
    ::unlink(beside.c_str());
    return cannot(ErrorCode::cannot_write, path, "cannot be written", reason);
}

std::string beside(const std::string& path, std::string_view name) {
    return (std::filesystem::path(path).parent_path() / std::filesystem::path(name)).string();
}

std::string ending(const std::string& path) {
    std::string out = std::filesystem::path(path).extension().string();
    std::transform(out.begin(), out.end(), out.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return out;
}

}  // namespace exitance
