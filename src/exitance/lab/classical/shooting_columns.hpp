#pragma once

#include <atomic>
#include <optional>
#include <span>
#include <vector>

#include "exitance/lab/classical/classical.hpp"
#include "exitance/lab/classical/element_vertices.hpp"
#include "exitance/transport/hemicube_rows.hpp"
#include "exitance/transport/patch_transfer.hpp"

namespace exitance {

/// Patches, which shoot light, and the receivers of that light.
struct ShootingMesh {
    ElementTree tree;
    std::vector<ElementId> patches;
    std::vector<double> patch_area;  ///< m^2
    /// Receivers: the leaves in the order of their ids. Elements that have been cut since stay in the list, with area
    /// and form factors of 0. Receivers keep their numbers; new ones are appended.
    std::vector<ElementId> receivers = {};
    std::vector<double> area = {};  ///< Per receiver, m^2.
    ElementVertices vertices = {};  ///< Vertices of the receivers, if light is gathered there.

    /// The leaves of a tree become the patches.
    explicit ShootingMesh(ElementTree leaves_are_patches)
        : tree(std::move(leaves_are_patches)), patches(tree.leaves()) {
        for (const ElementId patch : patches) patch_area.push_back(tree.area(patch));
    }
};

/// Columns of form factors: from all receivers, or from all vertices, to one patch. They come from formulas and rays,
/// or from the rows of patches by hemicubes or rays, which reciprocity turns into columns: F_ij = F_ji A_j / A_i. A
/// column is computed when it is requested. It is kept if it fits into `column_memory`; of a kept column, only the
/// entries of later receivers are computed.
class ShootingColumns {
  public:
    /// Both arguments must outlive the object.
    ShootingColumns(const MethodInput& input, const ShootingMesh& mesh);

    /// Returns the form factors from all receivers to a patch, which are valid until the next call for receivers.
    std::span<const float> of_receivers(std::size_t patch);
    /// Returns the form factors from all vertices to a patch, which are valid until the next call for vertices.
    std::span<const float> of_vertices(std::size_t patch);

    /// Computes the form factors from the receivers from number `first` on, which were added last.
    void of_new_receivers(std::size_t patch, std::size_t first, std::span<double> factors);
    /// Returns a column of all vertices in which only the entries from number `first` on are valid.
    std::span<const float> of_new_vertices(std::size_t patch, std::size_t first);

    /// Must be called after elements were added to the mesh.
    void update_elements() { transfer_.update_places(); }
    /// Must be called after vertices were added to the mesh.
    void update_vertices();
    /// Sets the kept form factors of a receiver to 0.
    void drop(std::size_t receiver);

    std::size_t rays() const;
    std::size_t form_factors() const { return transfer_.form_factors() + form_factors_; }
    std::size_t kept_bytes() const { return kept_bytes_; }

  private:
    static constexpr std::size_t none = ~std::size_t(0);

    std::size_t samples() const { return input_.options.visibility_samples.value_or(default_visibility_samples); }
    float factor_at(std::size_t vertex, std::size_t patch) const;
    void fill_column(std::size_t patch, std::size_t first);
    void keep_end(std::vector<float>& kept, std::span<const float> column);

    const MethodInput& input_;
    const ShootingMesh& mesh_;
    bool at_vertices_;  ///< True if the light of a receiver is the mean of its vertices.
    PatchTransfer transfer_;
    std::optional<HemicubeRows> hemicubes_;
    std::optional<RayRows> ray_rows_;
    std::vector<float> column_, vertex_column_;                ///< The columns computed last.
    std::size_t vertex_column_of_ = none;                      ///< Patch of `vertex_column_`, or none.
    std::vector<std::vector<float>> kept_, kept_at_vertices_;  ///< Column of each patch; may lack the newest receivers.
    std::size_t kept_bytes_ = 0;
    mutable std::atomic<std::size_t> rays_{0}, form_factors_{0};
};

}  // namespace exitance
