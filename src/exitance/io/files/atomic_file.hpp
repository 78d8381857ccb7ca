#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "exitance/base/result.hpp"

namespace exitance {

/// Writes a file that appears whole or not at all: the content goes to a temporary file in the same folder, which
/// commit() flushes to the disk and renames. Until then an existing file of that name is unchanged. If the path is a
/// symbolic link, the link is kept and its target is replaced. A path that is not a plain file (a pipe, a terminal,
/// /dev/null) is written to directly. Without commit() no file is left.
/// Errors: ErrorCode::cannot_write, with the path and the system's reason.
class AtomicFile {
  public:
    static Result<AtomicFile> create(const std::string& path);
    static AtomicFile standard_output();

    AtomicFile(AtomicFile&& other) noexcept;
    AtomicFile& operator=(AtomicFile&& other) noexcept;
    ~AtomicFile();

    /// Appends to the file, buffered. commit() reports a failure, so callers need not check after each call.
    void write(std::string_view text);
    void write(std::span<const std::byte> bytes) {
        write(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
    }
    /// Writes `bytes` at offset `place`, in bytes, for formats that are not written in order. Must not be combined with
    /// write(). If the path is not a plain file, the content is collected in memory and commit() writes it in order.
    void write_at(std::size_t place, std::span<const std::byte> bytes);
    /// Reads back the bytes at offset `place`: zeros where nothing was written or reading fails.
    void read_at(std::size_t place, std::span<std::byte> bytes);
    /// True if a write has failed so far.
    bool failed() const { return error_ != 0; }
    Result<void> commit();

    /// Removes the temporary files of all AtomicFiles; see remove_unfinished_files().
    static void remove_unfinished() noexcept;

  private:
    AtomicFile() = default;
    void flush();
    void abandon();
    int seekable();
    void pass_on_kept();

    std::string path_;       ///< The path as the user wrote it, for messages.
    std::string target_;     ///< The final path, with links resolved.
    std::string temporary_;  ///< Path of the temporary file; empty if the path is written to directly.
    struct Unfinished;
    Unfinished* unfinished_ = nullptr;  ///< Entry in the list of files that signal handlers remove.
    std::string buffer_;
    int file_ = -1;
    int kept_ = -1;  ///< Memory file that collects write_at() for a path that is not a plain file; -1: none.
    int error_ = 0;  ///< errno of the first failure.
    bool sync_ = true;
};

/// Removes the temporary files of all files that have not been committed. Async-signal-safe: for signal handlers that
/// end the program.
void remove_unfinished_files() noexcept;

/// Writes a whole file, as AtomicFile does.
Result<void> write_file(const std::string& path, std::string_view content);

}  // namespace exitance
