#include "exitance/io/files/atomic_file.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "exitance/io/files/write_error.hpp"

namespace exitance {
namespace {

constexpr std::size_t buffer_bytes = 1 << 18;

/// Resolves symbolic links, so that renaming replaces the file and not the link.
std::string resolved(const std::string& path) {
    char* real = ::realpath(path.c_str(), nullptr);
    std::string target = real ? real : path;
    std::free(real);
    return target;
}

int write_all(int file, const char* data, std::size_t size) {
    while (size > 0) {
        const ssize_t n = ::write(file, data, size);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return errno;
        data += n, size -= static_cast<std::size_t>(n);
    }
    return 0;
}

/// Permissions of a newly created file. The umask can only be read by setting it, so it is set and restored.
mode_t new_file_mode() {
    const mode_t mask = ::umask(022);
    ::umask(mask);
    return 0666 & ~mask;
}

}  // namespace

/// Name of an uncommitted temporary file, stored where signal handlers may read it.
struct AtomicFile::Unfinished {
    static constexpr std::size_t max_path_bytes = 4096;
    enum State : int { free, taken, named };
    std::atomic<int> state{free};
    std::array<char, max_path_bytes> path{};

    /// Stores `name` in a free entry. Returns null if no entry is free or the name is too long; signal handlers then
    /// leave that file behind.
    static Unfinished* enter(const std::string& name) {
        if (name.size() >= max_path_bytes) return nullptr;
        for (Unfinished& entry : all) {
            int expected = free;
            if (!entry.state.compare_exchange_strong(expected, taken)) continue;
            std::copy(name.c_str(), name.c_str() + name.size() + 1, entry.path.begin());
            entry.state = named;
            return &entry;
        }
        return nullptr;
    }

    static std::array<Unfinished, 16> all;
};
std::array<AtomicFile::Unfinished, 16> AtomicFile::Unfinished::all;

void AtomicFile::remove_unfinished() noexcept {
    for (const Unfinished& entry : Unfinished::all)
        if (entry.state == Unfinished::named) ::unlink(entry.path.data());
}

void remove_unfinished_files() noexcept {
    AtomicFile::remove_unfinished();
}

Result<AtomicFile> AtomicFile::create(const std::string& path) {
    AtomicFile out;
    out.path_ = path;
    if (path.empty()) return Error{ErrorCode::cannot_write, "cannot write a file without a name", "", ""};
    struct stat present;
    const bool exists = ::stat(path.c_str(), &present) == 0;
    if (exists && S_ISDIR(present.st_mode)) return cannot_write(path, EISDIR);
    if (exists && !S_ISREG(present.st_mode)) {
        out.file_ = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
        out.sync_ = false;
        if (out.file_ < 0) return cannot_write(path, errno);
        return out;
    }
    if (exists && ::access(path.c_str(), W_OK) != 0) return cannot_write(path, errno);  // a plain open would fail too
    out.target_ = exists ? resolved(path) : path;
    const std::size_t name = out.target_.rfind('/') + 1;  // 0 if the path has no folder
    std::string temporary = out.target_.substr(0, name) + "." + out.target_.substr(name) + ".XXXXXX";
    out.file_ = ::mkostemp(temporary.data(), O_CLOEXEC);
    if (out.file_ < 0) return cannot_write(path, errno);
    out.temporary_ = temporary;
    out.unfinished_ = Unfinished::enter(temporary);
    ::fchmod(out.file_, exists ? present.st_mode & 07777 : new_file_mode());
    return out;
}

AtomicFile AtomicFile::standard_output() {
    AtomicFile out;
    out.path_ = "standard output";
    out.file_ = ::dup(STDOUT_FILENO);
    out.error_ = out.file_ < 0 ? errno : 0;
    out.sync_ = false;
    return out;
}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept {
    *this = std::move(other);
}

AtomicFile& AtomicFile::operator=(AtomicFile&& other) noexcept {
    if (this == &other) return *this;
    abandon();
    path_ = std::move(other.path_), target_ = std::move(other.target_);
    temporary_ = std::exchange(other.temporary_, {});
    unfinished_ = std::exchange(other.unfinished_, nullptr);
    buffer_ = std::exchange(other.buffer_, {});
    file_ = std::exchange(other.file_, -1), kept_ = std::exchange(other.kept_, -1);
    error_ = other.error_, sync_ = other.sync_;
    return *this;
}

AtomicFile::~AtomicFile() {
    abandon();
}

void AtomicFile::abandon() {
    if (file_ >= 0) ::close(std::exchange(file_, -1));
    if (kept_ >= 0) ::close(std::exchange(kept_, -1));
    if (!temporary_.empty()) ::unlink(std::exchange(temporary_, {}).c_str());
    if (unfinished_) std::exchange(unfinished_, nullptr)->state = Unfinished::free;
}

void AtomicFile::flush() {
    if (error_ == 0) error_ = write_all(file_, buffer_.data(), buffer_.size());
    buffer_.clear();
}

void AtomicFile::write(std::string_view text) {
    if (buffer_.size() + text.size() > buffer_bytes) flush();
    if (text.size() > buffer_bytes) {
        if (error_ == 0) error_ = write_all(file_, text.data(), text.size());
    } else {
        buffer_.append(text);
    }
}

/// Returns the file that write_at() writes to.
int AtomicFile::seekable() {
    if (!temporary_.empty()) return file_;
    if (kept_ < 0 && (kept_ = ::memfd_create("exitance", MFD_CLOEXEC)) < 0 && error_ == 0) error_ = errno;
    return kept_;
}

void AtomicFile::write_at(std::size_t place, std::span<const std::byte> bytes) {
    const int file = seekable();
    while (!bytes.empty() && error_ == 0) {
        const ssize_t n = ::pwrite(file, bytes.data(), bytes.size(), static_cast<off_t>(place));
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) {
            error_ = errno;
            return;
        }
        place += static_cast<std::size_t>(n), bytes = bytes.subspan(static_cast<std::size_t>(n));
    }
}

void AtomicFile::read_at(std::size_t place, std::span<std::byte> bytes) {
    const int file = seekable();
    while (!bytes.empty() && file >= 0) {
        const ssize_t n = ::pread(file, bytes.data(), bytes.size(), static_cast<off_t>(place));
        if (n < 0 && errno == EINTR) continue;
        if (n < 0 && error_ == 0) error_ = errno;
        if (n <= 0) break;
        place += static_cast<std::size_t>(n), bytes = bytes.subspan(static_cast<std::size_t>(n));
    }
    std::fill(bytes.begin(), bytes.end(), std::byte{0});
}

/// Copies the memory file to the path that is written to directly.
void AtomicFile::pass_on_kept() {
    std::array<std::byte, 1 << 16> block;
    struct stat held;
    if (kept_ < 0 || error_ != 0) return;
    const std::size_t size = ::fstat(kept_, &held) == 0 ? static_cast<std::size_t>(held.st_size) : 0;
    for (std::size_t done = 0; done < size && error_ == 0;) {
        const std::span<std::byte> part = std::span(block).first(std::min(block.size(), size - done));
        read_at(done, part);
        if (error_ == 0) error_ = write_all(file_, reinterpret_cast<const char*>(part.data()), part.size());
        done += part.size();
    }
}

Result<void> AtomicFile::commit() {
    flush();
    pass_on_kept();
    if (error_ == 0 && sync_ && ::fsync(file_) != 0) error_ = errno;
    if (file_ >= 0 && ::close(std::exchange(file_, -1)) != 0 && error_ == 0) error_ = errno;
    if (error_ == 0 && !temporary_.empty()) {
        if (::rename(temporary_.c_str(), target_.c_str()) != 0) {
            error_ = errno;
        } else {
            temporary_.clear();  // a power failure may restore the old file, whole: the folder is not flushed
        }
    }
    abandon();
    if (error_ != 0) return cannot_write(path_, error_);
    return {};
}

Result<void> write_file(const std::string& path, std::string_view content) {
    Result<AtomicFile> file = AtomicFile::create(path);
    if (!file) return file.error();
    file->write(content);
    return file->commit();
}

}  // namespace exitance
