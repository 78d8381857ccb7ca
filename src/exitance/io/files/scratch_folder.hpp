#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

#include "exitance/base/result.hpp"

namespace exitance {

/// A folder in the system's temporary folder, which the destructor removes with its content.
class ScratchFolder {
  public:
    static Result<ScratchFolder> make(const std::string& name) {
        std::error_code failed;
        std::string path = (std::filesystem::temp_directory_path(failed) / (name + "-XXXXXX")).string();
        if (failed || !::mkdtemp(path.data()))
            return Error{ErrorCode::cannot_write, "cannot make a folder for temporary files", path, "set TMPDIR"};
        return ScratchFolder(path);
    }
    ScratchFolder(ScratchFolder&& other) noexcept : path_(std::move(other.path_)) { other.path_.clear(); }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    ~ScratchFolder() {
        std::error_code failed;
        if (!path_.empty()) std::filesystem::remove_all(path_, failed);
    }
    const std::string& path() const { return path_; }

  private:
    explicit ScratchFolder(std::string path) : path_(std::move(path)) {}

    std::string path_;
};

}  // namespace exitance
