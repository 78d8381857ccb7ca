#pragma once

#include <vector>

#include "exitance/base/bvh.hpp"
#include "exitance/lab/growing_cells/cell_light.hpp"
#include "exitance/solution/solution.hpp"

namespace exitance {

/// Exponent q of a cell's weight exp(-q) at a point x with normal n:
///
///     q = |t|^2 / d^2 + h^2 / (s_h d)^2 + (1 - n . n_c) / s_n,
///
/// where t and h are the components of x - w_c in the cell's plane and perpendicular to it. In the plane the weight is
/// the isotropic Gaussian of the published method. The second term keeps a cell from reaching a parallel surface behind
/// its own, the third from reaching across folds; facets that are tilted by a few degrees are still reached. Thus
/// surfaces are separated by their shape, not by their tessellation.
double cell_distance(const CellLight::Cell& cell, const Point& x, const Normal& n);

/// Returns a cell's weight on the plane through x with normal n, relative to its isotropic Gaussian; at most 1. Where
/// outputs are summed, the weight of a cell is this constant times exp(-|x - w_c|^2 / d^2), so that integrals over
/// polygons have a closed form. The constant is exp(-q + |x' - w_c|^2 / d^2) at the point x' of the plane nearest to
/// w_c.
double share_on_plane(const CellLight::Cell& cell, const Point& x, const Normal& n);

/// Evaluates the light of cells at points.
class CellFunction {
  public:
    /// Keeps a reference to `light`. O(cells log cells).
    explicit CellFunction(const CellLight& light);

    /// Irradiance at x on a surface with normal n, W/m^2: the sum over cells within three widths of v_c times
    /// `share_on_plane` exp(-|x - w_c|^2 / d^2) or, if `normalised`, the mean of v_c + slope . (x - w_c) with weights
    /// exp(-q). If no cell is near, the result is that of the nearest cell with a similar normal (normalised), or 0
    /// (summed). Never negative.
    Spectrum at(const Point& x, const Normal& n) const;

    /// Calls visit(cell, weight) for every cell within three widths, in the order of the search index.
    template <class Visit>
    void visit(const Point& x, const Normal& n, const Visit& visit) const {
        Box here;
        here.add(x);
        index_.visit_box(here, [&](std::uint32_t c) {
            const double weight = weight_at(light_->cells[c], x, n);
            if (weight > 0) visit(c, weight);
        });
    }
    static constexpr double cutoff = 9;  ///< q beyond which a cell has no weight: three widths.

  private:
    double weight_at(const CellLight::Cell& cell, const Point& x, const Normal& n) const;
    std::uint32_t nearest(const Point& x, const Normal& n) const;

    const CellLight* light_;
    Bvh index_;  ///< Boxes of three widths around the cells.
};

/// Cells as the engine evaluates and keeps them.
class CellsForm final : public LightForm {
  public:
    static constexpr std::string_view name = "growing cells";

    explicit CellsForm(CellLight light) : light_(std::move(light)), function_(light_) {}
    CellsForm(const CellsForm&) = delete;
    CellsForm& operator=(const CellsForm&) = delete;

    std::string_view kind() const override { return name; }
    Spectrum at(const Scene& scene, RegionId region, const Point& x) const override {
        return function_.at(x, scene.regions()[region].plane.n);
    }
    std::string packed() const override;
    static LightFormPointer unpack(std::string_view bytes);

    const CellLight& light() const { return light_; }
    const CellFunction& function() const { return function_; }

  private:
    CellLight light_;
    CellFunction function_;
};

/// The cells of a solution; empty where it has none.
const CellLight& cells_of(const Solution& solution);

}  // namespace exitance
