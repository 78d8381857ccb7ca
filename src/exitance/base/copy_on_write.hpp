#pragma once

#include <memory>
#include <utility>

namespace exitance {

/// A value whose copies share memory until one of them is changed. Any number of threads may read; while one thread
/// changes a value, no other thread may copy it.
template <class T>
class CopyOnWrite {
  public:
    CopyOnWrite() : value_(std::make_shared<T>()) {}

    const T& operator*() const { return *value_; }
    const T* operator->() const { return value_.get(); }

    /// Returns the value for modification. Copies it first if it is shared: O(size of T).
    T& change() {
        if (value_.use_count() > 1) value_ = std::make_shared<T>(*value_);
        return *value_;
    }

  private:
    std::shared_ptr<T> value_;
};

}  // namespace exitance
