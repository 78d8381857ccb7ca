#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

namespace exitance {

/// The numbers [0, n) sorted by group; within a group they ascend. O(n).
class Groups {
  public:
    Groups() = default;
    /// Number i belongs to group `group_of[i]`, which is less than `count`.
    Groups(std::span<const std::uint32_t> group_of, std::size_t count)
        : first_(count + 1, 0), members_(group_of.size()) {
        for (std::uint32_t g : group_of) ++first_[g + 1];
        std::partial_sum(first_.begin(), first_.end(), first_.begin());
        std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
        for (std::uint32_t i = 0; i < group_of.size(); ++i) members_[next[group_of[i]]++] = i;
    }

    std::span<const std::uint32_t> operator[](std::size_t group) const {
        return std::span(members_).subspan(first_[group], first_[group + 1] - first_[group]);
    }

  private:
    std::vector<std::uint32_t> first_, members_;
};

}  // namespace exitance
