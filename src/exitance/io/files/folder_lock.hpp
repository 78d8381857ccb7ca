#pragma once

#include <string>

#include "exitance/base/result.hpp"

namespace exitance {

/// A folder that one process alone works in, as long as this lives; it ends with the process however that ends. No file
/// is made. File systems that know no locks give it to everyone.
class FolderLock {
  public:
    /// ErrorCode::cannot_write when another process has it.
    static Result<FolderLock> take(const std::string& folder);

    FolderLock(FolderLock&& other) noexcept;
    FolderLock& operator=(FolderLock&&) = delete;
    ~FolderLock();

  private:
    explicit FolderLock(int file) : file_(file) {}
    int file_;
};

}  // namespace exitance
