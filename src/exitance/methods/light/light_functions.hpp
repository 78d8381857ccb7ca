#pragma once

#include "exitance/evaluate/quick_function.hpp"
#include "exitance/solve/global_light.hpp"
#include "exitance/transport/direct_projection.hpp"

namespace exitance {

// What a method found, as functions that rays and files can read.

/// An indirect light of nothing: every piece one element, dark.
ElementFunction dark(const Stage& stage);

/// Light as a method left it on its elements: constant on every leaf.
ElementFunction constant_on_leaves(const GlobalLight& light);

/// Light as a method's polynomials have it.
ElementFunction polynomials_on_leaves(const GlobalLight& light);

/// What rays read in the local pass, b + c M: on every leaf the direct light that was projected there, and the indirect
/// light that the method found, times the reflectance, and the share c of what it emits (`find_direct_share`). Where
/// the method's own elements agree with that share, E_dir + E_ind is alike all over a leaf but for (1 - c) E_dir.
ElementFunction gathered_light(const Scene& scene, const DirectProjection& direct, const GlobalLight& light,
                               const Spectrum& c);

/// Scales direct light, as projected, to be what surfaces emit, band by band, where all of that arrives (`is_closed`)
/// and nothing else shines. Means at the places of a rule are off where shadows cross elements: by up to 3e-3 of all
/// light where those are as coarse as 5% asks for. Returns the scale.
Spectrum keep_emitted_flux(DirectProjection& direct, const Stage& stage, std::uint64_t seed);

/// Does all light that the method's elements reflect arrive?
bool keeps_reflected_light(const Stage& stage, const GlobalLight& light, std::uint64_t seed);

/// Scales indirect light E, as gathered, to be what of it and of direct light arrives, band by band:
///
///     int E dA = int k (rho ((1 - c) E_dir + E) + c M) dA,
///
/// k from the leaves that the method solved on, 1 where it does not say. In a closed scene this is the balance of what
/// is emitted and absorbed. What rays and places of a local pass miss in the mean, a share of about 1e-3, is light
/// dealt out otherwise than the method had it, among surfaces that reflect more and less of it. Nothing happens where
/// much escapes (`is_kept`). Returns the scale.
Spectrum keep_flux(ElementFunction& E, const Scene& scene, const DirectProjection& direct, const GlobalLight& light,
                   const Spectrum& c);

/// W, by band: all that arrives, where E is the function.
Spectrum power(const ElementFunction& E);

/// The same of what functions together send, as far as the method kept it (`GlobalLight::kept`); 0 where much escapes.
Spectrum arriving_power(const Scene& scene, const GlobalLight& light, std::span<const ElementFunction> b);

/// Multiplies all values, by band.
void scale(ElementFunction& f, const Spectrum& factor);

/// Does E have that balance, as `keep_flux` left it, and does hardly anything escape?
bool has_kept_flux(const ElementFunction& E, const Scene& scene, const DirectProjection& direct,
                   const GlobalLight& light, const Spectrum& c);

/// Reflected light of what a solution delivers, plus the share c of what is emitted: rho (E_ind + (1 - c) E_dir) + c M,
/// where `indirect` holds E_ind + c E_dir and direct light is read as projected.
class DeliveredLight final : public ReflectedLight {
  public:
    /// `direct_weight` of the projection: 1 - c, or 0 where `indirect` holds all light. The scene must outlive it.
    DeliveredLight(const Scene& scene, const ElementFunction& indirect, const DirectProjection& direct,
                   const Spectrum& direct_weight, const Spectrum& c);

    void read(std::span<const HitPoint> hits, std::span<Spectrum> values) const override;

    /// Reads E_dir as projected, W/m^2; its leaves are those of the projection.
    const QuickFunction& projected() const { return direct_; }

  private:
    const Scene& scene_;
    QuickFunction indirect_, direct_;
    Spectrum direct_weight_, c_;
};

/// The same as functions to be summed over elements; what they hold adds up.
std::vector<ElementFunction> delivered_functions(const Scene& scene, const ElementFunction& indirect,
                                                 const DirectProjection& direct, const Spectrum& direct_weight,
                                                 const Spectrum& c);

/// The light that every room reflects, by the mean light; at least a millionth, since nothing can be relative to none.
/// Empty where all is one room.
std::vector<double> light_by_room(const Stage& stage, const GlobalLight& light);

/// What errors rooms may have, in proportion: their light l, but where few hold most of it less, since the error of all
/// together is held to the demand, too. Capped at c:  sum of (area share) min(l, c)^2 <= `of_all`, by which the square
/// of the whole's error may come to that many times the demand's. Empty where `light_in` is.
std::vector<double> allowed_by_room(const Stage& stage, std::span<const double> light_in, double of_all);

/// RMS over the surfaces of the standard error of rho E_ind, where a method is a random one, W/m^2.
double rms_standard_error(const Stage& stage, const GlobalLight& light);

}  // namespace exitance
