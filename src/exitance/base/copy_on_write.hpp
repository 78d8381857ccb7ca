#pragma once

#include <memory>
#include <utility>

namespace exitance {

/// A value whose copies share one place in memory until one of them is changed. Reading is safe from any number of
/// threads; a value that is being changed must be no other thread's to copy.
template <class T>
class CopyOnWrite {
  public:
    CopyOnWrite() : value_(std::make_shared<T>()) {}

    const T& operator*() const { return *value_; }
    const T* operator->() const { return value_.get(); }

    /// The value, to be changed: this object's own from here on. O(size of T) where it was shared.
    T& change() {
        if (value_.use_count() > 1) value_ = std::make_shared<T>(*value_);
        return *value_;
    }

  private:
    std::shared_ptr<T> value_;
};

}  // namespace exitance
