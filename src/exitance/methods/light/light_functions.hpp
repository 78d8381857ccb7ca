#pragma once

#include "exitance/evaluate/quick_function.hpp"
#include "exitance/gather/lost_light.hpp"
#include "exitance/scene/bodies.hpp"
#include "exitance/solve/global_light.hpp"
#include "exitance/transport/direct_projection.hpp"

namespace exitance {

// Conversion of a method's light to functions for rays and files.

/// Indirect light of zero: one dark element per piece.
ElementFunction dark(const Stage& stage);

/// A method's indirect light, constant on every leaf.
ElementFunction constant_on_leaves(const GlobalLight& light);

/// A method's indirect light as its polynomials.
ElementFunction polynomials_on_leaves(const GlobalLight& light);

/// Radiosity b + c M that rays read in the local pass: on every leaf the reflectance times projected direct light plus
/// indirect light, plus the share c of the exitance (`find_direct_share`). If the method's own elements used that
/// share, E_dir + E_ind is uniform over a leaf except for (1 - c) E_dir.
ElementFunction gathered_light(const Scene& scene, const DirectProjection& direct, const GlobalLight& light,
                               const Spectrum& c);

/// Scales projected direct light so that its flux equals the emitted flux in each band, if all emitted light arrives
/// (`is_closed`) and there are no other light sources. Means from sample points are off where shadows cross elements:
/// by up to 3e-3 of all light for elements of a 5% error. Returns the scale.
Spectrum keep_emitted_flux(DirectProjection& direct, const Stage& stage, std::uint64_t seed);

/// True if all light that the method's elements reflect arrives at fronts of surfaces, as tested by rays in proportion
/// to the reflected power.
bool keeps_reflected_light(const Stage& stage, const GlobalLight& light, std::uint64_t seed);

/// False if the method's losses (`GlobalLight::kept`) are so large that light cannot be scaled to what arrives.
bool may_keep_flux(const Stage& stage, const GlobalLight& light);

/// The light of a method that reaches no front; zero if the method's rays lost none.
LostLight find_lost_light(const Stage& stage, const GlobalLight& light, std::uint64_t seed);

/// Scales gathered indirect light E in each band so that it equals the part of E and of direct light that arrives:
///
///     int E dA = int (rho ((1 - c) E_dir + E) + c M) dA - lost,
///
/// where `lost` is the part of that light which reaches no front. In a closed scene this is the balance of emitted and
/// absorbed light. The mean error of a local pass, a share of about 1e-3, is light that it
/// distributes differently from the method among surfaces of different reflectance. Does nothing if much light escapes
/// (`is_kept`). Returns the scale.
Spectrum keep_flux(ElementFunction& E, const Scene& scene, const DirectProjection& direct, const LostLight& lost,
                   const Spectrum& c);

/// Total arriving power of irradiance E, W, per band.
Spectrum power(const ElementFunction& E);

/// Arriving power of the light that functions `b` together send, W, per band. 0 if much light escapes.
Spectrum arriving_power(const Scene& scene, const LostLight& lost, std::span<const ElementFunction> b);

/// Multiplies all values, per band.
void scale(ElementFunction& f, const Spectrum& factor);

/// True if E is balanced, as after `keep_flux`, and almost no light escapes.
bool has_kept_flux(const ElementFunction& E, const Scene& scene, const DirectProjection& direct, const LostLight& lost,
                   const Spectrum& c);

/// Reflected light of a solution, plus the share c of the exitance: rho (E_ind + (1 - c) E_dir) + c M, where `indirect`
/// is E_ind + c E_dir and direct light is read from the projection.
class DeliveredLight final : public ReflectedLight {
  public:
    /// `direct_weight`: weight of projected light, 1 - c, or 0 if `indirect` contains all light. `scene` must outlive
    /// this.
    DeliveredLight(const Scene& scene, const ElementFunction& indirect, const DirectProjection& direct,
                   const Spectrum& direct_weight, const Spectrum& c);

    void read(std::span<const RayEnd> hits, std::span<Spectrum> values) const override;

    /// Projected E_dir, W/m^2; its leaves are those of the projection.
    const QuickFunction& projected() const { return direct_; }

  private:
    const Scene& scene_;
    QuickFunction indirect_, direct_;
    Spectrum direct_weight_, c_;
};

/// The light of `DeliveredLight` as functions to be summed over elements. Their sum is that light.
std::vector<ElementFunction> delivered_functions(const Scene& scene, const ElementFunction& indirect,
                                                 const DirectProjection& direct, const Spectrum& direct_weight,
                                                 const Spectrum& c);

/// Raises the light of dark rooms to a millionth of the brightest one, since errors are relative to it.
void raise_dark_rooms(std::span<double> light);

/// Reflected light of every room relative to the mean, at least a millionth of the brightest, since errors are relative
/// to it. Empty if there is only one room.
std::vector<double> light_by_room(const Stage& stage, const GlobalLight& light);

/// Mean reflected radiosity of every room, W/m^2, of delivered light; see DeliveredLight for the arguments. It is more
/// accurate than light_by_room(): in a dim room beside a bright ground, the method's elements may be off by a third.
/// Empty if there is only one room.
std::vector<double> delivered_by_room(const Stage& stage, const ElementFunction& indirect,
                                      const DirectProjection& direct, const Spectrum& direct_weight);

/// Returns, for every body, the radiosity to which its error is relative, W/m^2: the mean light that the body reflects,
/// but at least a tenth of its room's. `light_in`: light_by_room().
std::vector<double> light_of_bodies(const Stage& stage, const GlobalLight& light, const SceneBodies& bodies,
                                    std::span<const double> light_in);

/// Permitted errors of rooms, in proportion to their light l but capped at c:
///
///     sum of (area share) min(l, c)^2 <= `of_all`.
///
/// The cap keeps the squared error of all rooms together within `of_all` times the requested one if few rooms have most
/// of the light. Empty if `light_in` is.
std::vector<double> allowed_by_room(const Stage& stage, std::span<const double> light_in, double of_all);

/// RMS over the surfaces of the standard error of rho E_ind, W/m^2. 0 unless the method is a random one.
double rms_standard_error(const Stage& stage, const GlobalLight& light);

}  // namespace exitance
