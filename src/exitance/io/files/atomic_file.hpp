#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "exitance/base/result.hpp"

namespace exitance {

/// A file that appears whole or not at all: written beside its place in the same folder, flushed to the disk, renamed.
/// A file of that name stays as it is until then; a symbolic link goes on to lead to the same place. What is not a
/// plain file (a pipe, a terminal, /dev/null) is written to directly. Without commit() nothing is left behind.
/// Failures are ErrorCode::cannot_write, with the path and what the system says.
class AtomicFile {
  public:
    static Result<AtomicFile> create(const std::string& path);
    static AtomicFile standard_output();

    AtomicFile(AtomicFile&& other) noexcept;
    AtomicFile& operator=(AtomicFile&& other) noexcept;
    ~AtomicFile();

    /// Gathers small pieces; a failure is remembered and reported by commit(), so that loops need not look.
    void write(std::string_view text);
    void write(std::span<const std::byte> bytes) {
        write(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
    }
    /// The same anywhere in the file, for what goes back and forth in it; not together with write(). What is no plain
    /// file gets it all by commit(), in its order.
    void write_at(std::size_t place, std::span<const std::byte> bytes);
    /// What stands there; zeros where nothing was written, or could be.
    void read_at(std::size_t place, std::span<std::byte> bytes);
    /// Has the system refused anything so far?
    bool failed() const { return error_ != 0; }
    Result<void> commit();

    /// See remove_unfinished_files.
    static void remove_unfinished() noexcept;

  private:
    AtomicFile() = default;
    void flush();
    void abandon();
    int seekable();
    void pass_on_kept();

    std::string path_;       ///< As the user wrote it, for messages.
    std::string target_;     ///< Where it is renamed to.
    std::string temporary_;  ///< Empty when written to directly.
    struct Unfinished;
    Unfinished* unfinished_ = nullptr;  ///< Its entry among the files that handlers of signals remove.
    std::string buffer_;
    int file_ = -1;
    int kept_ = -1;  ///< A file in memory that stands for one that is not plain until commit().
    int error_ = 0;  ///< The first failure, as errno.
    bool sync_ = true;
};

/// Removes what has been written beside the places of all files that are not whole yet. Async-signal-safe: for handlers
/// that end the program.
void remove_unfinished_files() noexcept;

/// Writes a file in one go.
Result<void> write_file(const std::string& path, std::string_view content);

}  // namespace exitance
