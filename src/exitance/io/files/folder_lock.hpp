#pragma once

#include <string>

#include "exitance/base/result.hpp"

namespace exitance {

/// Exclusive lock of a folder for one process, held while this object exists and released when the process ends in any
/// way. Creates no file. On file systems without locks, taking the lock always succeeds.
class FolderLock {
  public:
    /// Locks `folder`. Error: ErrorCode::cannot_write if another process holds the lock.
    static Result<FolderLock> take(const std::string& folder);

    FolderLock(FolderLock&& other) noexcept;
    FolderLock& operator=(FolderLock&&) = delete;
    ~FolderLock();

  private:
    explicit FolderLock(int file) : file_(file) {}
    int file_;
};

}  // namespace exitance
