#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

#include "exitance/base/check.hpp"

namespace exitance {

/// The index of one thing in its pool. Ids of different kinds of objects have different types, so that they cannot be
/// mixed up.
template <class Tag>
struct Id {
    static constexpr std::uint32_t none_value = 0xffffffffu;
    std::uint32_t value = none_value;

    constexpr Id() = default;
    constexpr explicit Id(std::size_t v) : value(static_cast<std::uint32_t>(v)) {}
    constexpr bool is_none() const { return value == none_value; }
    constexpr auto operator<=>(const Id&) const = default;
};

/// Consecutive ids, [first, last).
template <class AnyId>
class IdRange {
  public:
    class Iterator {
      public:
        using value_type = AnyId;
        using difference_type = std::ptrdiff_t;
        using iterator_category = std::forward_iterator_tag;
        using pointer = const AnyId*;
        using reference = AnyId;
        Iterator() = default;
        explicit Iterator(std::uint32_t v) : v_(v) {}
        AnyId operator*() const { return AnyId(v_); }
        Iterator& operator++() { return ++v_, *this; }
        Iterator operator++(int) { return Iterator(v_++); }
        bool operator==(const Iterator&) const = default;

      private:
        std::uint32_t v_ = 0;
    };

    constexpr IdRange() = default;
    constexpr IdRange(std::size_t first, std::size_t last)
        : first_(static_cast<std::uint32_t>(first)), last_(static_cast<std::uint32_t>(last)) {}
    Iterator begin() const { return Iterator(first_); }
    Iterator end() const { return Iterator(last_); }
    AnyId front() const { return AnyId(first_); }
    AnyId operator[](std::size_t i) const { return AnyId(first_ + i); }
    std::size_t size() const { return last_ - first_; }
    bool empty() const { return first_ == last_; }

  private:
    std::uint32_t first_ = 0, last_ = 0;
};

/// One value per object of a pool: a vector that can be indexed only by ids of that pool.
template <class AnyId, class T>
class Field {
  public:
    Field() = default;
    explicit Field(std::size_t n, const T& value = T()) : values_(n, value) {}

    T& operator[](AnyId id) { return EXI_ASSERT(id.value < values_.size()), values_[id.value]; }
    const T& operator[](AnyId id) const { return EXI_ASSERT(id.value < values_.size()), values_[id.value]; }

    AnyId add(T value) { return values_.push_back(std::move(value)), AnyId(values_.size() - 1); }
    void resize(std::size_t n, const T& value = T()) { values_.resize(n, value); }
    void reserve(std::size_t n) { values_.reserve(n); }
    void shrink_to_fit() { values_.shrink_to_fit(); }
    std::size_t size() const { return values_.size(); }
    bool empty() const { return values_.empty(); }
    IdRange<AnyId> ids() const { return {0, values_.size()}; }
    std::span<T> span() { return values_; }
    std::span<const T> span() const { return values_; }
    auto begin() const { return values_.begin(); }
    auto end() const { return values_.end(); }
    auto begin() { return values_.begin(); }
    auto end() { return values_.end(); }

  private:
    std::vector<T> values_;
};

}  // namespace exitance
