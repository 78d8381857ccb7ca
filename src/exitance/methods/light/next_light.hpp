#pragma once

#include "exitance/methods/light/light_functions.hpp"
#include "exitance/transport/ray_rows.hpp"

namespace exitance {

/// Light to be gathered by another attempt, one step of iterative refinement on from what was delivered, where light is
/// found by rays (`refined_light` is the same for sums). From b gathered before and E = H b delivered,
///
///     b' = b1 + ((I - rho F)^-1 - I) P (b1 - b),    b1 = rho (E_dir + E)
///
/// (with the share c of `find_direct_share`, see DeliveredLight): P takes means over the leaves that the method solved
/// on, F are rays between those. So what is rough in b becomes what the gather found, without any finer element of the
/// method, and what is smooth in its error, which comes back from every reflection, is solved for. b' - b is small:
/// gathered by itself, it takes few rays. Source: [Atkinson97], part "two-grid iteration".
struct NextLight {
    /// Functions on what was delivered, and on the mesh of direct light, that add up to b'; or the one that is b.
    std::vector<ElementFunction> parts;
    /// With the first of `parts` it adds up to b' - b; one function, or none where b' has been gathered already.
    std::vector<ElementFunction> rest = {};

    template <class Archive>
    void archive_state(Archive& a) {
        a(parts, rest);
    }
};

/// The step on from `before`, whose gather is delivered as `indirect`. `light` has to be on the leaves of `direct`.
/// Takes what stands in `before`. O(leaves + rays).
NextLight next_light(const Stage& stage, const GlobalLight& light, const ElementFunction& indirect,
                     const DirectProjection& direct, const Spectrum& c, NextLight before, RayBudget rays,
                     std::uint64_t seed);

/// The same for rays to read.
class ReadNextLight {
  public:
    /// `next` must outlive it.
    ReadNextLight(const NextLight& next, std::size_t region_count);
    ReadNextLight(const ReadNextLight&) = delete;
    ReadNextLight& operator=(const ReadNextLight&) = delete;

    /// Does it need `next` no more?
    bool stands_alone() const;

    const ReflectedLight& whole() const { return whole_; }             ///< b'
    const ReflectedLight* change() const { return change_.if_any(); }  ///< b' - b, or null.
    /// Of the mesh that the method solved on.
    const ElementLocator& method_mesh() const { return parts_.back().locator(); }

  private:
    class Sum final : public ReflectedLight {
      public:
        void add(const QuickFunction& part) { parts_.push_back(&part); }
        const ReflectedLight* if_any() const { return parts_.size() > 1 ? this : nullptr; }
        void read(std::span<const HitPoint> hits, std::span<Spectrum> values) const override;

      private:
        std::vector<const QuickFunction*> parts_;
    };

    std::vector<QuickFunction> parts_, rest_;
    Sum whole_, change_;
};

}  // namespace exitance
