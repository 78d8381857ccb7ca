#pragma once

#include "exitance/error/certificate_places.hpp"
#include "exitance/error/direct_check.hpp"
#include "exitance/mesh/element_locator.hpp"

namespace exitance {

/// One point of the certificate: two independent estimates of the residual there.
struct ResidualSample {
    ElementTree::Place place;  ///< In the delivered function.
    RegionId region;
    SurfaceId surface;
    std::uint32_t room = 0;
    bool is_covered = false;  ///< By another surface: it is dark there, and told to be, whatever is delivered.
    double weight = 0;
    Spectrum r1, r2;          ///< The residual.
    double squared = 0;       ///< Of the error there, mean over the bands, (W/m^2)^2.
    Spectrum local1, local2;  ///< Its part by the local pass, where known.
    bool tells_local = false;
    Spectrum delivered;      ///< E there, less direct light, W/m^2.
    double reflected = 0;    ///< Radiosity there less exitance, with direct light as projected, mean over bands, W/m^2.
    std::uint32_t leaf = 0;  ///< Leaf number in the coarse mesh.
    std::uint32_t rays = 0;
};

/// Rays of each of the two gathers at so many points by which a relative error of their mean can be told. A gather of n
/// rays has a variance in proportion to 1 / n, and so has the product of two; hence for noise in the mean product that
/// is a share of the error's square
///
///     n = `certificate_noise` / (error^2 sqrt(points)).
double rays_to_tell(double error, std::size_t points);

/// So many rays as a power of two, within the limits of a certificate.
unsigned certificate_rays(double wanted);

/// Measures residuals of a delivered function at points: see `Certifier`.
class ResidualSampler {
  public:
    struct Workspace {
        GatherWorkspace rays;
        ElementGather::Workspace sums;
        ClusteredLight::Workspace clustered;
        DirectCheck::Workspace check;
    };

    /// `constant` is the factor from the residual to the bound on the error. `coarse` finds leaves that `numbering`
    /// numbers. All but numbers must outlive it.
    ResidualSampler(const Stage& stage, const ElementFunction& indirect, const ReflectedLight& b,
                    const DirectCheck& check, const CertificateOptions& options, double constant,
                    const ElementLocator& coarse, const LeafNumbering& numbering);

    /// Measures the residual at places, twice each, into as many samples; `plan` tells how the direct light at hits is
    /// checked. O(places x rays), parallel.
    void measure(std::span<const WeightedSample> places, const CheckPlan& plan, std::uint64_t seed,
                 std::span<ResidualSample> samples) const;

    /// Fills in where a sample lies and what is delivered there.
    void locate(const WeightedSample& place, ResidualSample& sample, Workspace& w) const;

    /// The residual at a point once more, by so many rays.
    Spectrum by_rays(const ResidualSample& sample, const CheckPlan& plan, unsigned rays, std::uint64_t key,
                     Workspace& workspace) const;

    /// Rays of each half of a sample by which projected direct light is checked where reflected light is summed.
    static constexpr unsigned rays_beside_sums = 32;

  private:
    void sum_elements(std::uint64_t seed, std::size_t k, const CheckPlan& plan, ResidualSample& sample,
                      Workspace& w) const;
    void cast_rays(std::uint64_t seed, std::size_t k, const CheckPlan& plan, ResidualSample& sample,
                   Workspace& w) const;
    unsigned rays_at(ElementId leaf) const;
    Point point(const ResidualSample& sample) const;

    const Stage& stage_;
    const ElementFunction& indirect_;
    const ReflectedLight& b_;
    const DirectCheck& check_;
    const CertificateOptions& options_;
    double often_;  ///< More rays, where light is reflected often.
    const ElementLocator& coarse_;
    const LeafNumbering& numbering_;
};

}  // namespace exitance
