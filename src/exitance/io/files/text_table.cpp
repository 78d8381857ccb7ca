#include "exitance/io/files/text_table.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "exitance/base/words.hpp"

namespace exitance {
namespace {

constexpr std::size_t block_bytes = 1 << 18;
constexpr std::size_t max_line_bytes = 1 << 24;  ///< A longer line shows that the file is not text.

/// Takes the next field of a CSV line, without blanks and quotation marks. `line` then begins after the field's comma.
std::string_view next_field(std::string_view& line) {
    std::size_t end = line.find(',');
    const std::string_view start = without_blanks(line);
    if (!start.empty() && start.front() == '"') {
        const std::size_t open = line.find('"'), close = line.find('"', open + 1);
        if (close != std::string_view::npos) {
            const std::string_view inside = line.substr(open + 1, close - open - 1);
            end = line.find(',', close);
            line.remove_prefix(end == std::string_view::npos ? line.size() : end + 1);
            return without_blanks(inside);
        }
    }
    const std::string_view field = line.substr(0, end);
    line.remove_prefix(end == std::string_view::npos ? line.size() : end + 1);
    return without_blanks(field);
}

/// Quotes text from a file for a message: at most 40 characters, only printable ASCII.
std::string quoted(std::string_view text) {
    std::string out = "\"";
    for (char c : text.substr(0, 40)) out += c >= ' ' && c <= '~' ? c : '?';
    return out + (text.size() > 40 ? "...\"" : "\"");
}

}  // namespace

Result<LineReader> LineReader::open(const std::string& path) {
    LineReader out;
    out.name_ = path == "-" ? "standard input" : path;
    out.file_ = path == "-" ? ::dup(STDIN_FILENO) : ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    out.error_ = out.file_ < 0 ? errno : 0;
    if (out.error_ == 0) out.fill();  // a folder can be opened, but not read
    if (out.failed()) return out.read_error();
    const std::string_view begin(out.buffer_.data(), out.end_);
    if (begin.find('\n') == begin.npos && begin.find('\r') != begin.npos) out.line_end_ = '\r';
    if (std::string_view(out.buffer_).substr(0, out.end_).starts_with("\xef\xbb\xbf")) out.begin_ = 3;
    return out;
}

LineReader::LineReader(LineReader&& other) noexcept
    : name_(std::move(other.name_)),
      buffer_(std::move(other.buffer_)),
      begin_(other.begin_),
      end_(other.end_),
      file_(std::exchange(other.file_, -1)),
      line_(other.line_),
      error_(other.error_),
      at_end_(other.at_end_),
      line_end_(other.line_end_) {}

LineReader::~LineReader() {
    if (file_ >= 0) ::close(file_);
}

Error LineReader::read_error() const {
    return {ErrorCode::cannot_read, std::string("cannot be read: ") + std::strerror(error_), name_, ""};
}

Error LineReader::error(std::string message, std::string hint) const {
    const std::string where = line_ > 0 ? name_ + ":" + std::to_string(line_) : name_;
    return {ErrorCode::bad_input, std::move(message), where, std::move(hint)};
}

/// Reads more bytes after those not yet used; false at the end of the file.
bool LineReader::fill() {
    if (at_end_ || failed()) return false;
    if (begin_ > 0) {
        std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
        end_ -= begin_, begin_ = 0;
    }
    if (end_ > max_line_bytes) return error_ = EFBIG, false;
    if (buffer_.size() - end_ < block_bytes) buffer_.resize(end_ + std::max(block_bytes, end_));
    ssize_t n = 0;
    do n = ::read(file_, buffer_.data() + end_, buffer_.size() - end_);
    while (n < 0 && errno == EINTR);
    if (n < 0) return error_ = errno, false;
    end_ += static_cast<std::size_t>(n);
    at_end_ = n == 0;
    return n > 0;
}

std::optional<std::string_view> LineReader::next() {
    std::size_t looked_at = 0;
    for (;;) {
        const char* start = buffer_.data() + begin_;
        const void* found = std::memchr(start + looked_at, line_end_, end_ - begin_ - looked_at);
        std::size_t length = end_ - begin_;
        if (found) length = static_cast<std::size_t>(static_cast<const char*>(found) - start);
        if (!found) {
            looked_at = length;
            if (fill()) continue;
            if (failed() || length == 0) return {};
            start = buffer_.data() + begin_;  // the last line has no line end
        }
        begin_ += length + (found ? 1 : 0);
        ++line_;
        if (length > 0 && start[length - 1] == '\r') --length;
        return std::string_view(start, length);
    }
}

std::optional<std::string_view> LineReader::next_content() {
    while (const auto line = next()) {
        const std::size_t first = line->find_first_not_of(" \t");
        if (first != std::string_view::npos && (*line)[first] != '#') return line;
    }
    return {};
}

std::optional<double> parse_number(std::string_view text) {
    text = without_blanks(text);
    if (text.starts_with('+')) text.remove_prefix(1);
    double value = 0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (end != text.data() + text.size() || text.empty()) return {};
    if (failure == std::errc::result_out_of_range) {
        // A number that is too small becomes 0; one that is too large is rejected.
        const std::size_t exponent = text.find_first_of("eE");
        if (exponent != std::string_view::npos && text.substr(exponent + 1).starts_with('-')) return 0.0;
        return {};
    }
    if (failure != std::errc()) return {};
    return value;
}

Result<NumberTable> NumberTable::open(const std::string& path, const std::vector<std::string>& required,
                                      const std::vector<std::string>& optional) {
    Result<LineReader> lines = LineReader::open(path);
    if (!lines) return lines.error();
    const auto header = lines->next_content();
    if (lines->failed()) return lines->read_error();
    if (!header) return lines->error("is empty: there is no header line");
    const std::string copy(*header);
    return open(std::move(*lines), copy, required, optional);
}

Result<NumberTable> NumberTable::open(LineReader lines, std::string_view header,
                                      const std::vector<std::string>& required,
                                      const std::vector<std::string>& optional) {
    NumberTable table(std::move(lines));
    table.required_ = required.size();
    table.names_ = required;
    table.names_.insert(table.names_.end(), optional.begin(), optional.end());
    std::vector<bool> found(table.names_.size());
    std::vector<std::string_view> names;
    while (!header.empty()) {
        const std::string_view name = names.emplace_back(next_field(header));
        const auto known = std::find(table.names_.begin(), table.names_.end(), name);
        const auto slot = static_cast<std::size_t>(known - table.names_.begin());
        const bool wanted = known != table.names_.end() && !found[slot];
        if (wanted) found[slot] = true;
        table.slot_.push_back(wanted ? static_cast<int>(slot) : -1);
    }
    for (std::size_t i = 0; i < table.required_; ++i)
        if (!found[i]) {
            std::string all;
            for (const std::string& name : required) all += (all.empty() ? "" : ",") + name;
            const bool semicolons = std::any_of(names.begin(), names.end(), [](std::string_view name) {
                return name.find(';') != std::string_view::npos;
            });
            return table.lines_.error(
                "the header has no column " + table.names_[i],
                semicolons ? "separate columns by commas and write decimal points: " + all : "it needs " + all);
        }
    table.has_.assign(found.begin() + static_cast<std::ptrdiff_t>(table.required_), found.end());
    // Columns after the last requested one are not parsed.
    while (!table.slot_.empty() && table.slot_.back() < 0) table.slot_.pop_back();
    return table;
}

Result<bool> NumberTable::next(std::span<double> row) {
    const auto line = lines_.next_content();
    if (lines_.failed()) return lines_.read_error();
    if (!line) return false;
    std::fill(row.begin(), row.end(), std::numeric_limits<double>::quiet_NaN());
    std::string_view rest = *line;
    for (const int slot : slot_) {
        const std::string_view field = next_field(rest);
        if (slot < 0) continue;
        const auto s = static_cast<std::size_t>(slot);
        if (field.empty()) {
            if (s < required_) return lines_.error("column " + names_[s] + " is empty");
            continue;
        }
        const std::optional<double> value = parse_number(field);
        if (!value || !std::isfinite(*value))
            return lines_.error("column " + names_[s] + " holds " + quoted(field) + ", not a finite number");
        row[s] = *value;
    }
    return true;
}

}  // namespace exitance
