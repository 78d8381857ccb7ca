#pragma once

#include "exitance/methods/light/light_functions.hpp"
#include "exitance/methods/light/refinement_input.hpp"

namespace exitance {

/// Light for the gather of another attempt: one step of iterative refinement, for light gathered by rays
/// (`corrected_sums` does the same for sums). From b gathered before and E = H b delivered,
///
///     b' = b1 + ((I - rho F)^-1 - I) P (b1 - b),    b1 = rho (E_dir + E)
///
/// (with the share c of `find_direct_share`, see DeliveredLight). P takes means over the method's leaves, F are rays
/// between those. Details of b are replaced by those of the gather without refining the method's elements. Smooth
/// errors, which every reflection multiplies, are solved for. b' - b is small, so few rays suffice to gather it
/// separately. Source: [Atkinson97], part "two-grid iteration".
struct NextLight {
    /// Functions whose sum is b', on the delivered mesh and on the mesh of direct light; or a single function b.
    std::vector<ElementFunction> parts;
    /// Function whose sum with the first of `parts` is b' - b. Empty if b' has been gathered already.
    std::vector<ElementFunction> rest = {};

    template <class Archive>
    void archive_state(Archive& a) {
        a(parts, rest);
    }
};

/// Computes the step after `before`, whose gather is delivered as `in.indirect`. `in.light` must be on the leaves of
/// `in.direct`. Moves from `before`. O(leaves + rays).
NextLight next_light(const RefinementInput& in, NextLight before);

/// NextLight as functions that rays can read.
class ReadNextLight {
  public:
    /// `next` must outlive this unless `stands_alone()`.
    ReadNextLight(const NextLight& next, std::size_t region_count);
    ReadNextLight(const ReadNextLight&) = delete;
    ReadNextLight& operator=(const ReadNextLight&) = delete;

    /// True if `next` is not needed any more.
    bool stands_alone() const;

    const ReflectedLight& whole() const { return whole_; }  ///< b'
    /// Returns the change b' - b; null if there is none.
    const ReflectedLight* change() const { return change_.if_any(); }
    /// Places at which rays that gather b' are aimed.
    void aim_at(const BrightPlaces& places) { whole_.aim_at(places); }
    /// Locator of the method's mesh.
    const ElementLocator& method_mesh() const { return parts_.back().locator(); }

  private:
    class Sum final : public ReflectedLight {
      public:
        void add(const QuickFunction& part) { parts_.push_back(&part); }
        const ReflectedLight* if_any() const { return parts_.size() > 1 ? this : nullptr; }
        void read(std::span<const RayEnd> hits, std::span<Spectrum> values) const override;

      private:
        std::vector<const QuickFunction*> parts_;
    };

    std::vector<QuickFunction> parts_, rest_;
    Sum whole_, change_;
};

}  // namespace exitance
