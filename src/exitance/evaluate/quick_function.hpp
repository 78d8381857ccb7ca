#pragma once

#include "exitance/gather/gather.hpp"
#include "exitance/mesh/element_locator.hpp"
#include "exitance/solution/solution.hpp"

namespace exitance {

/// A function on elements for rays, which read it in great numbers: the leaves under many hits are found together, and
/// a leaf's polynomial stands in one line of memory. The same values as the function's, up to single precision.
/// Leaves that the finder does not hold, of many triangles of fans, have their polynomials made where they are read.
class QuickFunction final : public ReflectedLight {
  public:
    /// Stands once a node where several processes make it, as all of them have to. Where the finder does
    /// not hold all leaves, the function must outlive this.
    QuickFunction(const ElementFunction& function, std::size_t region_count);

    void read(std::span<const HitPoint> hits, std::span<Spectrum> values) const override;

    /// Does it need the function no more?
    bool stands_alone() const { return function_ == nullptr; }
    const ElementLocator& locator() const { return locator_; }

  private:
    /// Of 1, u, v, uv, where (u, v) are the coordinates of the leaf's root, from a middle of the leaf.
    struct alignas(64) Polynomial {
        float u, v;
        std::array<std::array<float, bands>, 4> coefficient;
    };

    Polynomial polynomial(ElementId leaf, ElementId root) const;

    const ElementFunction* function_;  ///< Null where every leaf has its polynomial.
    ElementLocator locator_;
    std::vector<Polynomial> leaves_;  ///< By leaf number.
};

}  // namespace exitance
