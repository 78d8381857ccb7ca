#pragma once

#include <cstdint>
#include <fstream>
#include <span>
#include <string>
#include <vector>

#include "exitance/base/check.hpp"
#include "exitance/base/half.hpp"
#include "exitance/io/files/atomic_file.hpp"

namespace exitance {

/// Number types of NumPy files.
enum class NpyType : std::uint8_t { float16, float32, float64 };

template <class T>
constexpr NpyType npy_type() {
    if constexpr (std::is_same_v<T, Half>) return NpyType::float16;
    if constexpr (std::is_same_v<T, float>) return NpyType::float32;
    if constexpr (std::is_same_v<T, double>) return NpyType::float64;
}

/// Writes an array of NumPy (.npy, version 1.0, little-endian, C order) row by row. The file appears whole or not at
/// all.
class NpyWriter {
  public:
    /// Error: ErrorCode::cannot_write.
    static Result<NpyWriter> create(const std::string& path, NpyType type, std::size_t rows, std::size_t columns);

    /// Appends numbers of the file's type, in row order.
    template <class T>
    void append(std::span<const T> values) {
        EXI_ASSERT(npy_type<T>() == type_);
        file_.write(std::as_bytes(values));
    }
    template <class T>
    void append(const std::vector<T>& values) {
        append(std::span<const T>(values));
    }
    Result<void> commit() { return file_.commit(); }

  private:
    NpyWriter(AtomicFile file, NpyType type) : file_(std::move(file)), type_(type) {}

    AtomicFile file_;
    NpyType type_;
};

/// Reads rows of a two-dimensional array that NpyWriter or NumPy has written.
class NpyReader {
  public:
    /// Errors: ErrorCode::cannot_read; bad_input if the header is not one of a little-endian array of numbers in C
    /// order with two dimensions, or if the file does not have the size that it says.
    static Result<NpyReader> open(const std::string& path);

    NpyType type() const { return type_; }
    std::size_t rows() const { return rows_; }
    std::size_t columns() const { return columns_; }

    /// Reads whole rows as numbers of the file's type. Error: ErrorCode::cannot_read.
    template <class T>
    Result<std::vector<T>> read(std::size_t first, std::size_t count) {
        EXI_ASSERT(npy_type<T>() == type_);
        std::vector<T> out(count * columns_);
        const Result<void> done = read_at(first * columns_, std::as_writable_bytes(std::span(out)));
        if (!done) return done.error();
        return out;
    }

  private:
    NpyReader() = default;
    Result<void> read_at(std::size_t item, std::span<std::byte> out);
    Result<void> parse(const std::string& header, std::uint64_t bytes);

    std::string path_;
    std::ifstream file_;
    NpyType type_ = NpyType::float32;
    std::size_t rows_ = 0, columns_ = 0;
    std::uint64_t begin_ = 0;  ///< Place of the first number, bytes.
};

/// Bytes of a number.
constexpr std::size_t npy_bytes(NpyType type) {
    return type == NpyType::float16 ? 2 : type == NpyType::float32 ? 4 : 8;
}

}  // namespace exitance
