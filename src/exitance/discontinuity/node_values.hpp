#pragma once

#include <functional>
#include <span>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/discontinuity/weak_light.hpp"
#include "exitance/mesh/discontinuity/bisection_mesh.hpp"

namespace exitance {

/// Irradiance at the nodes of a growing mesh, W/m^2. Nodes are evaluated on request, each once.
class NodeValues {
  public:
    using Look = std::function<Spectrum(std::uint32_t node, WeakLight::Workspace&)>;

    /// Supplies the values that an earlier run has found, in the order of their evaluation. The first nodes that are
    /// requested take these values, which relies on the same order of requests.
    void resume(std::vector<Spectrum> found) { found_ = std::move(found); }

    /// Evaluates `look` at the nodes that have no value yet, some thousand at a time, and calls `keep` after each
    /// batch. Duplicates are allowed. Returns false if `stop` is requested before the end; the nodes of the present
    /// batch then stay without a value.
    bool look_at(std::vector<std::uint32_t> nodes, const Look& look, const StopRequest& stop,
                 const std::function<void()>& keep);

    /// Per node. Entries of nodes that have not been evaluated are meaningless.
    std::span<const Spectrum> values() const { return values_; }
    bool has(std::uint32_t node) const { return node < has_.size() && has_[node] != 0; }
    /// Returns the values in the order of evaluation, as `resume` takes them; the values given to `resume` if those are
    /// more.
    std::vector<Spectrum> in_order() const;

  private:
    std::vector<Spectrum> values_, found_;
    std::vector<std::uint8_t> has_;
    std::vector<std::uint32_t> order_;  ///< Nodes in the order of evaluation.
};

}  // namespace exitance
