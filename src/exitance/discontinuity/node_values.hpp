#pragma once

#include <functional>
#include <span>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/discontinuity/weak_light.hpp"
#include "exitance/mesh/discontinuity/bisection_mesh.hpp"

namespace exitance {

/// Light at the nodes of a mesh that grows, W/m^2: only at those that were asked for, and once at each.
class NodeValues {
  public:
    using Look = std::function<Spectrum(std::uint32_t node, WeakLight::Workspace&)>;

    /// Goes on from what an earlier run has found: its values, in the order in which they were asked for. They are the
    /// first ones that will be asked for again.
    void resume(std::vector<Spectrum> found) { found_ = std::move(found); }

    /// Lights the nodes that have no light yet, some thousand at once, and calls `keep` after these. False, and those
    /// at hand stay without light, where a request to stop cuts it short. Duplicates do no harm.
    bool look_at(std::vector<std::uint32_t> nodes, const Look& look, const StopRequest& stop,
                 const std::function<void()>& keep);

    /// By node; of those without light no meaning.
    std::span<const Spectrum> values() const { return values_; }
    bool has(std::uint32_t node) const { return node < has_.size() && has_[node] != 0; }
    /// What `resume` takes: what there is, or what it was given where that is more.
    std::vector<Spectrum> in_order() const;

  private:
    std::vector<Spectrum> values_, found_;
    std::vector<std::uint8_t> has_;
    std::vector<std::uint32_t> order_;  ///< In which nodes were asked for.
};

}  // namespace exitance
