#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "exitance/base/ids.hpp"

namespace exitance {

/// The part of one writer in a byte stream that `of` writers share block by block, round robin: block b belongs to
/// writer b % of.
struct DealtBytes {
    static constexpr std::size_t block = std::size_t(1) << 14;

    std::size_t own = 0, of = 1;  ///< Index of this writer, and the number of writers.
};

/// Reassembles the byte stream from the parts of all writers, in order. Returns an empty string if the sizes of the
/// parts do not match a round-robin distribution.
inline std::string put_together(std::span<const std::string> dealt) {
    std::string all;
    std::size_t size = 0;
    for (const std::string& part : dealt) size += part.size();
    all.reserve(size);
    for (std::size_t b = 0; all.size() < size; ++b) {
        const std::string& part = dealt[b % dealt.size()];
        const std::size_t first = b / dealt.size() * DealtBytes::block,
                          count = std::min(DealtBytes::block, size - all.size());
        if (first > part.size() || part.size() - first < count) return {};
        all.append(part, first, count);
    }
    return all;
}

/// Serializes values to bytes, to be read back by the same program on the same machine. One template defines both
/// directions of a type:
///
///     template <class Archive> void archive(Archive& a, Thing& thing) { a(thing.name, thing.values); }
class ArchiveWriter {
  public:
    static constexpr bool reads = false;

    /// Stores only the blocks of the stream that belong to this writer. All writers must be given the same values.
    explicit ArchiveWriter(DealtBytes dealt = {}) : dealt_(dealt) {}

    template <class... T>
    void operator()(T&... values) {
        (archive(*this, values), ...);
    }
    void raw(const void* data, std::size_t size) {
        const char* from = static_cast<const char*>(data);
        for (std::size_t count = 0; size > 0; from += count, size -= count, written_ += count) {
            count = std::min(size, DealtBytes::block - written_ % DealtBytes::block);
            if (written_ / DealtBytes::block % dealt_.of == dealt_.own) bytes_.append(from, count);
        }
    }
    /// Size of the whole stream, over all writers, bytes.
    std::size_t size() const { return written_; }
    std::string take() { return std::move(bytes_); }

  private:
    DealtBytes dealt_;
    std::size_t written_ = 0;
    std::string bytes_;
};

/// Reads values back from bytes. If bytes are missing, the values are zero and good() is false.
class ArchiveReader {
  public:
    static constexpr bool reads = true;

    explicit ArchiveReader(std::string_view bytes) : bytes_(bytes) {}
    template <class... T>
    void operator()(T&... values) {
        (archive(*this, values), ...);
    }
    void raw(void* data, std::size_t size) {
        good_ = good_ && size <= bytes_.size();
        if (!good_) return void(std::memset(data, 0, size));
        std::memcpy(data, bytes_.data(), size);
        bytes_.remove_prefix(size);
    }
    void fail() { good_ = false; }
    std::size_t left() const { return bytes_.size(); }
    bool good() const { return good_; }

  private:
    std::string_view bytes_;
    bool good_ = true;
};

/// Writes or reads the number of elements that follow. When reading, a count that needs more than the remaining bytes
/// (at `bytes_each` per element) fails and returns 0, so that damaged input allocates no memory.
template <class Archive>
std::size_t archive_size(Archive& a, std::size_t size, std::size_t bytes_each) {
    std::uint64_t count = size;
    if constexpr (Archive::reads) {
        a.raw(&count, sizeof count);
        if (count > a.left() / bytes_each) count = 0, a.fail();
    } else {
        a.raw(&count, sizeof count);
    }
    return count;
}

/// Trivially copyable values: stored byte for byte.
template <class Archive, class T>
requires std::is_trivially_copyable_v<T>
void archive(Archive& a, T& value) {
    a.raw(const_cast<void*>(static_cast<const void*>(&value)), sizeof value);
}

/// A bool is read through a byte, since a bool whose byte is neither 0 nor 1 is undefined behaviour; any byte but 0 is
/// true.
template <class Archive>
void archive(Archive& a, bool& value) {
    std::uint8_t byte = value;
    a.raw(&byte, 1);
    value = byte != 0;
}

template <class Archive, class T>
void archive(Archive& a, std::vector<T>& values) {
    constexpr bool plain = std::is_trivially_copyable_v<T>;
    values.resize(archive_size(a, values.size(), plain ? sizeof(T) : 1));
    if constexpr (plain) {
        if (!values.empty()) a.raw(values.data(), values.size() * sizeof(T));
    } else {
        for (T& value : values) a(value);
    }
}

template <class Archive, class AnyId, class T>
requires std::is_trivially_copyable_v<T>
void archive(Archive& a, Field<AnyId, T>& field) {
    field.resize(archive_size(a, field.size(), sizeof(T)));
    if (!field.empty()) a.raw(field.span().data(), field.size() * sizeof(T));
}

template <class Archive>
void archive(Archive& a, std::string& text) {
    text.resize(archive_size(a, text.size(), 1));
    if (!text.empty()) a.raw(text.data(), text.size());
}

template <class Archive, class T>
requires(!std::is_trivially_copyable_v<T>) void archive(Archive& a, std::optional<T>& value) {
    bool there = value.has_value();
    a(there);
    if constexpr (Archive::reads) {
        value.reset();
        if (there) value.emplace();
    }
    if (value) a(*value);
}

template <class Archive>
void archive(Archive& a, std::map<std::string, double>& values) {
    std::vector<std::string> names;
    std::vector<double> numbers;
    for (const auto& [name, number] : values) names.push_back(name), numbers.push_back(number);
    a(names, numbers);
    if constexpr (Archive::reads) {
        values.clear();
        for (std::size_t i = 0; i < std::min(names.size(), numbers.size()); ++i) values[names[i]] = numbers[i];
    }
}

}  // namespace exitance
