#pragma once

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

namespace exitance {

/// What a command prints on both its outputs, and how it ended.
struct Ran {
    int status = -1;
    std::string output;
};
inline Ran run(const std::string& command) {
    Ran ran;
    std::FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
    if (!pipe) return ran;
    char block[4096];
    while (const std::size_t n = std::fread(block, 1, sizeof block, pipe)) ran.output.append(block, n);
    const int status = ::pclose(pipe);
    ran.status = status < 0 ? -1 : status >> 8 & 0xff;
    return ran;
}

/// A folder for the files of one test, gone with it.
class TemporaryFolder {
  public:
    TemporaryFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "exitance-XXXXXX").string();
        if (!::mkdtemp(name.data())) std::abort();
        path_ = name;
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    ~TemporaryFolder() { std::filesystem::remove_all(path_); }

    std::string operator/(const std::string& name) const { return (path_ / name).string(); }

  private:
    std::filesystem::path path_;
};

}  // namespace exitance
