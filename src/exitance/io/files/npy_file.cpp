#include "exitance/io/files/npy_file.hpp"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <regex>

namespace exitance {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::string_view magic("\x93NUMPY\x01\x00", 8);
constexpr std::size_t prefix = magic.size() + 2;  ///< Bytes before the header: magic and the header's length.
constexpr std::size_t alignment = 64;             ///< Numbers begin at a multiple of this.

}  // namespace

Result<NpyWriter> NpyWriter::create(const std::string& path, NpyType type, std::size_t rows, std::size_t columns) {
    Result<AtomicFile> file = AtomicFile::create(path);
    if (!file) return file.error();
    std::string header =
        fmt::format("{{'descr': '<f{}', 'fortran_order': False, 'shape': ({}, {}), }}", npy_bytes(type), rows, columns);
    const std::size_t size = prefix + header.size() + 1;
    header.append((alignment - size % alignment) % alignment, ' ');
    header += '\n';
    const std::array<char, 2> length{static_cast<char>(header.size() & 0xffu), static_cast<char>(header.size() >> 8)};
    file->write(magic);
    file->write(std::string_view(length.data(), length.size()));
    file->write(header);
    return NpyWriter(std::move(*file), type);
}

Result<NpyReader> NpyReader::open(const std::string& path) {
    NpyReader out;
    out.path_ = path;
    std::error_code failure;
    const std::uint64_t bytes = std::filesystem::file_size(path, failure);
    out.file_.open(path, std::ios::binary);
    if (failure || !out.file_)
        return Error{ErrorCode::cannot_read, std::string("cannot be read: ") + std::strerror(errno), path, ""};
    std::array<char, prefix> start{};
    out.file_.read(start.data(), start.size());
    if (!out.file_ || std::string_view(start.data(), magic.size()) != magic)
        return Error{ErrorCode::bad_input, "is not a NumPy file of version 1.0", path, ""};
    const std::size_t length = static_cast<unsigned char>(start[prefix - 2]) +
                               (static_cast<std::size_t>(static_cast<unsigned char>(start[prefix - 1])) << 8);
    std::string header(length, '\0');
    out.file_.read(header.data(), static_cast<std::streamsize>(length));
    if (!out.file_) return Error{ErrorCode::bad_input, "ends within its header", path, ""};
    out.begin_ = prefix + length;
    if (const Result<void> parsed = out.parse(header, bytes); !parsed) return parsed.error();
    return out;
}

Result<void> NpyReader::parse(const std::string& header, std::uint64_t bytes) {
    static const std::regex pattern(
        R"(\{'descr': '<f([248])', 'fortran_order': False, 'shape': \(([0-9]{1,12}), ([0-9]{1,9})\), \}\s*)");
    std::smatch match;
    if (!std::regex_match(header, match, pattern))
        return Error{ErrorCode::bad_input, "does not hold rows of little-endian floating-point numbers", path_, ""};
    type_ = match[1] == "2" ? NpyType::float16 : match[1] == "4" ? NpyType::float32 : NpyType::float64;
    rows_ = std::stoull(match[2]), columns_ = std::stoull(match[3]);
    const std::uint64_t wanted = begin_ + std::uint64_t{rows_} * columns_ * npy_bytes(type_);
    if (columns_ > 0 && rows_ > (std::uint64_t{1} << 60) / columns_)
        return Error{ErrorCode::bad_input, "claims too many numbers", path_, ""};
    if (bytes != wanted)
        return Error{ErrorCode::bad_input, fmt::format("has {} bytes instead of {}", bytes, wanted), path_, ""};
    return {};
}

Result<void> NpyReader::read_at(std::size_t item, std::span<std::byte> out) {
    file_.seekg(static_cast<std::streamoff>(begin_ + std::uint64_t{item} * npy_bytes(type_)));
    file_.read(reinterpret_cast<char*>(out.data()), static_cast<std::streamsize>(out.size()));
    if (!file_) return Error{ErrorCode::cannot_read, "cannot be read: it has become shorter", path_, ""};
    return {};
}

}  // namespace exitance
