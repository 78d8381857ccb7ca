#pragma once

#include "exitance/gather/gather.hpp"
#include "exitance/mesh/element_locator.hpp"
#include "exitance/solution/solution.hpp"

namespace exitance {

/// A function on elements for batches of ray hits: the leaves of many hits are found together, and a leaf's polynomial
/// occupies one cache line. Same values as the function's, up to single precision. Polynomials of leaves that the
/// finder does not store (triangles of many fans) are computed on demand.
class QuickFunction final : public ReflectedLight {
  public:
    /// With several processes there is one copy per node; the constructor is then collective. If the finder does not
    /// store all leaves, the function must outlive the object.
    QuickFunction(const ElementFunction& function, std::size_t region_count);

    void read(std::span<const RayEnd> hits, std::span<Spectrum> values) const override;

    /// True if the object does not use the function any more.
    bool stands_alone() const { return function_ == nullptr; }
    const ElementLocator& locator() const { return locator_; }

  private:
    /// Coefficients of 1, u, v, uv in the coordinates (u, v) of the leaf's root, relative to a centre of the leaf.
    struct alignas(64) Polynomial {
        float u, v;
        std::array<std::array<float, bands>, 4> coefficient;
    };

    Polynomial polynomial(ElementId leaf, ElementId root) const;

    const ElementFunction* function_;  ///< The function; null if every leaf's polynomial is stored.
    ElementLocator locator_;
    std::vector<Polynomial> leaves_;  ///< Polynomials by leaf number.
};

}  // namespace exitance
