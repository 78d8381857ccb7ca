#include "exitance/methods/light/light_functions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "exitance/base/parallel.hpp"
#include "exitance/calibration/numbers.hpp"
#include "exitance/solve/conserving_transport.hpp"
#include "exitance/transport/open_share.hpp"

namespace exitance {

ElementFunction dark(const Stage& stage) {
    ElementFunction out;
    for (const auto& [region, patch] : stage.pieces) out.tree.add_root(region, patch);
    out.first_value.resize(out.tree.size(), 0);
    out.values.assign(4, {});
    return out;
}

namespace {

/// Projected direct light as a function on every leaf.
ElementFunction as_function(const DirectProjection& direct) {
    ElementFunction out;
    out.tree = direct.tree;
    out.first_value.resize(out.tree.size(), 0);
    for (ElementId e : out.tree.leaves()) {
        out.first_value[e] = static_cast<std::uint32_t>(out.values.size());
        for (const Spectrum& corner : direct.fit[e].corners) out.add_value(corner);
    }
    return out;
}

}  // namespace

ElementFunction constant_on_leaves(const GlobalLight& light) {
    ElementFunction out;
    out.tree = light.tree;
    out.first_value.resize(out.tree.size(), 0);
    for (std::size_t i = 0; i < light.numbering.leaves.size(); ++i) {
        out.first_value[light.numbering.leaves[i]] = static_cast<std::uint32_t>(out.values.size());
        for (int corner = 0; corner < 4; ++corner) out.add_value(light.indirect[i]);
    }
    return out;
}

ElementFunction polynomials_on_leaves(const GlobalLight& light) {
    ElementFunction out;
    out.tree = light.tree;
    out.first_value.resize(out.tree.size(), 0);
    for (std::size_t i = 0; i < light.numbering.leaves.size(); ++i) {
        const ElementId e = light.numbering.leaves[i];
        out.first_value[e] = static_cast<std::uint32_t>(out.values.size());
        for (int corner = 0; corner < out.tree.patch(e).corner_count(); ++corner)
            out.add_value(light.indirect_corners[i][static_cast<std::size_t>(corner)]);
    }
    return out;
}

ElementFunction gathered_light(const Scene& scene, const DirectProjection& direct, const GlobalLight& light,
                               const Spectrum& c) {
    ElementFunction out;
    out.tree = light.tree;
    out.first_value.resize(out.tree.size(), 0);
    for (std::size_t i = 0; i < light.numbering.leaves.size(); ++i) {
        const ElementId e = light.numbering.leaves[i];
        const Material& material = scene.material(out.tree.region(e));
        out.first_value[e] = static_cast<std::uint32_t>(out.values.size());
        const Spectrum mean = light.direct_share * light.direct[i];
        for (std::size_t k = 0; k < 4; ++k) {
            const Spectrum& E_dir = light.on_projection            ? direct.fit[e].corners[k]
                                    : light.direct_corners.empty() ? light.direct[i]
                                                                   : light.direct_corners[i][k];
            const Spectrum& E_ind = light.indirect_corners.empty() ? light.indirect[i] : light.indirect_corners[i][k];
            out.add_value(material.reflectance * (E_dir - light.direct_share * E_dir + mean + E_ind) +
                          c * material.exitance);
        }
    }
    return out;
}

DeliveredLight::DeliveredLight(const Scene& scene, const ElementFunction& indirect, const DirectProjection& direct,
                               const Spectrum& direct_weight, const Spectrum& c)
    : scene_(scene),
      indirect_(indirect, scene.regions().size()),
      direct_(as_function(direct), scene.regions().size()),
      direct_weight_(direct_weight),
      c_(c) {}

void DeliveredLight::read(std::span<const RayEnd> hits, std::span<Spectrum> values) const {
    constexpr std::size_t batch_size = 64;
    std::array<Spectrum, batch_size> direct;
    indirect_.read(hits, values);
    for (std::size_t first = 0; first < hits.size(); first += batch_size) {
        const std::size_t count = std::min(batch_size, hits.size() - first);
        direct_.read(hits.subspan(first, count), std::span(direct).first(count));
        for (std::size_t i = 0; i < count; ++i) {
            const Material& material = scene_.material(hits[first + i].region);
            Spectrum& b = values[first + i];
            b = material.reflectance * (b + direct_weight_ * direct[i]) + c_ * material.exitance;
        }
    }
}

std::vector<ElementFunction> delivered_functions(const Scene& scene, const ElementFunction& indirect,
                                                 const DirectProjection& direct, const Spectrum& direct_weight,
                                                 const Spectrum& c) {
    std::vector<ElementFunction> out = {indirect, as_function(direct)};
    const auto turn = [&](ElementFunction& f, const Spectrum& factor, const Spectrum& emitted) {
        for (ElementId e : f.tree.leaves()) {
            const Material& material = scene.material(f.tree.region(e));
            const Spectrum rho = factor * material.reflectance, more = emitted * material.exitance;
            for (std::size_t i = 0; i < static_cast<std::size_t>(f.tree.patch(e).corner_count()); ++i) {
                std::array<float, bands>& value = f.values[f.first_value[e] + i];
                for (std::size_t k = 0; k < bands; ++k)
                    value[k] = static_cast<float>(rho[k] * static_cast<double>(value[k]) + more[k]);
            }
        }
    };
    turn(out[0], Spectrum(1.0), c), turn(out[1], direct_weight, Spectrum());
    return out;
}

namespace {

/// True if all light that leaves send arrives. `radiosity(leaf)`: W/m^2.
template <class Radiosity>
bool all_arrives(const Stage& stage, const ElementTree& tree, const LeafNumbering& numbering,
                 const Radiosity& radiosity, std::uint64_t seed) {
    std::vector<double> power = leaf_areas(tree, numbering);
    for (std::size_t i = 0; i < power.size(); ++i) power[i] *= mean(radiosity(numbering.leaves[i]));
    const ElementLocator locator(tree, stage.scene.regions().size());
    return is_closed(stage, {tree, numbering, locator}, seed, power);
}

}  // namespace

Spectrum keep_emitted_flux(DirectProjection& direct, const Stage& stage, std::uint64_t seed) {
    // is_closed casts diffuse rays only, so it says nothing about directed emitters and other lights
    if (stage.scene.has_light_apart() || stage.scene.has_directed_emission()) return Spectrum(1.0);
    const auto exitance = [&](ElementId e) { return stage.scene.material(direct.tree.region(e)).exitance; };
    if (!all_arrives(stage, direct.tree, LeafNumbering(direct.tree), exitance, seed)) return Spectrum(1.0);
    Spectrum emitted, received;  // W
    for (ElementId e : direct.tree.leaves()) {
        emitted += direct.tree.area(e) * exitance(e);
        received += direct.tree.area(e) * direct.fit[e].mean;
    }
    const Spectrum scale = conserving_scale(emitted, received);
    for (DirectFit& fit : direct.fit) {
        fit.mean *= scale;
        for (Spectrum& corner : fit.corners) corner *= scale;
    }
    return scale;
}

namespace {

/// Power that every leaf of the method sends, the share of emitted light that is gathered included, W, mean of bands.
std::vector<double> sent_power(const Scene& scene, const GlobalLight& light) {
    std::vector<double> out = leaf_areas(light.tree, light.numbering);
    for (std::size_t i = 0; i < out.size(); ++i) {
        const Spectrum& exitance = scene.material(light.tree.region(light.numbering.leaves[i])).exitance;
        out[i] *= mean(light.reflected[i] + light.direct_share * exitance);
    }
    return out;
}

}  // namespace

bool keeps_reflected_light(const Stage& stage, const GlobalLight& light, std::uint64_t seed) {
    return all_arrives(
        stage, light.tree, light.numbering, [&](ElementId e) { return light.reflected[light.numbering.number[e]]; },
        seed);
}

bool may_keep_flux(const Stage& stage, const GlobalLight& light) {
    if (light.kept.empty()) return true;
    constexpr double noise = 0.01;  // derived from 10^5 rays, whose standard error is far below this
    const std::vector<double> sent = sent_power(stage.scene, light);
    double all = 0, kept = 0;
    for (std::size_t i = 0; i < sent.size(); ++i) all += sent[i], kept += light.kept[i] * sent[i];
    return is_kept(Spectrum(kept + noise * all), Spectrum(all));
}

LostLight find_lost_light(const Stage& stage, const GlobalLight& light, std::uint64_t seed) {
    EXI_CHECK(light.kept.empty() || light.kept.size() == light.numbering.leaves.size());
    if (std::all_of(light.kept.begin(), light.kept.end(), [](double share) { return share == 1; })) return {};
    std::vector<double> power = sent_power(stage.scene, light);
    // Leaves that are dark to the method may have some delivered light.
    // Share of the mean radiosity. Derived from the need for some rays; the mean result is the same with any value.
    constexpr double dark = 0.01;
    const std::vector<double> area = leaf_areas(light.tree, light.numbering);
    const double mean_radiosity =
        std::accumulate(power.begin(), power.end(), 0.0) / std::accumulate(area.begin(), area.end(), 0.0);
    for (std::size_t i = 0; i < power.size(); ++i) power[i] += dark * mean_radiosity * area[i];
    return LostLight(stage, light.tree, light.numbering, power, seed);
}

namespace {

/// Power of the gathered indirect light and its expected value, W, per band.
struct FluxSums {
    Spectrum sent;          ///< Power that leaves surfaces.
    Spectrum first, again;  ///< Arriving power of reflected direct light, and of the reflected gathered light.
    Spectrum gathered;      ///< Power of the gathered light.
};

FluxSums flux_sums(const ElementFunction& E, const Scene& scene, const DirectProjection& direct, const LostLight& lost,
                   const Spectrum& c) {
    const auto emitted = [&](RegionId r) { return c * scene.material(r).exitance; };
    const auto of_direct = [&](RegionId r) { return scene.material(r).reflectance * (Spectrum(1.0) - c); };
    const auto reflectance = [&](RegionId r) { return scene.material(r).reflectance; };
    FluxSums out;
    for (RegionId r : scene.regions().ids()) out.first += scene.regions()[r].area * emitted(r);
    for (ElementId e : direct.tree.leaves())
        out.first += direct.tree.area(e) * (of_direct(direct.tree.region(e)) * direct.fit[e].mean);
    for (ElementId e : E.tree.leaves()) {
        // A linear or bilinear function has its mean at the centre of its element.
        const Spectrum power = E.tree.area(e) * E.at({e, E.tree.centre(e)});
        out.gathered += power;
        out.again += reflectance(E.tree.region(e)) * power;
    }
    out.sent = out.first + out.again;
    if (lost.is_zero()) return out;
    const std::size_t regions = scene.regions().size();
    const ElementFunction projected = as_function(direct);
    out.first -= lost.uniform_power(emitted) + lost.power(QuickFunction(projected, regions), of_direct);
    out.again -= lost.power(QuickFunction(E, regions), reflectance);
    return out;
}

}  // namespace

Spectrum keep_flux(ElementFunction& E, const Scene& scene, const DirectProjection& direct, const LostLight& lost,
                   const Spectrum& c) {
    const FluxSums power = flux_sums(E, scene, direct, lost, c);
    if (!is_kept(power.first + power.again, power.sent)) return Spectrum(1.0);
    const Spectrum factor = conserving_scale(power.first, power.gathered - power.again);
    scale(E, factor);
    return factor;
}

Spectrum power(const ElementFunction& E) {
    Spectrum out;
    for (ElementId e : E.tree.leaves()) out += E.tree.area(e) * E.at({e, E.tree.centre(e)});
    return out;
}

Spectrum arriving_power(const Scene& scene, const LostLight& lost, std::span<const ElementFunction> b) {
    Spectrum sent, arriving;
    for (const ElementFunction& f : b) {
        const Spectrum leaves = power(f);
        sent += leaves, arriving += leaves;
        if (!lost.is_zero())
            arriving -= lost.power(QuickFunction(f, scene.regions().size()), [](RegionId) { return Spectrum(1.0); });
    }
    return is_kept(arriving, sent) ? arriving : Spectrum();
}

void scale(ElementFunction& f, const Spectrum& factor) {
    for (std::array<float, bands>& value : f.values)
        for (std::size_t b = 0; b < bands; ++b) value[b] = static_cast<float>(factor[b] * value[b]);
}

bool has_kept_flux(const ElementFunction& E, const Scene& scene, const DirectProjection& direct, const LostLight& lost,
                   const Spectrum& c) {
    const FluxSums power = flux_sums(E, scene, direct, lost, c);
    // Share of the absorbed power, derived from the noise of escaping light when few rays find it.
    constexpr double negligible = 0.01;
    if (mean(power.sent - power.first - power.again) > negligible * mean(power.gathered - power.again)) return false;
    const double roundings = 1e-5 * mean(power.gathered);  // derived from the single precision of stored values
    return std::sqrt(squared(power.gathered - power.again - power.first) / static_cast<double>(bands)) <= roundings;
}

double rms_standard_error(const Stage& stage, const GlobalLight& light) {
    double sum = 0;
    for (std::size_t i = 0; i < light.standard_error.size(); ++i) {
        const ElementId e = light.numbering.leaves[i];
        const Spectrum& rho = stage.scene.material(light.tree.region(e)).reflectance;
        sum += light.tree.area(e) * squared(rho * light.standard_error[i]) / static_cast<double>(bands);
    }
    return std::sqrt(sum / stage.area);
}

namespace {

/// Mean over every room of a value that leaves have. Leaves at the borders of a room may be on either side, so that
/// their area differs from the room's.
template <class Value>
std::vector<double> mean_by_room(const Stage& stage, const ElementTree& tree, const Value& value) {
    std::vector<double> out(stage.rooms.count()), area(out.size());
    for (const ElementId e : tree.leaves()) {
        const std::size_t room = stage.rooms.of(tree, e);
        out[room] += tree.area(e) * value(e), area[room] += tree.area(e);
    }
    for (std::size_t room = 0; room < out.size(); ++room) out[room] /= area[room] > 0 ? area[room] : 1;
    return out;
}

}  // namespace

void raise_dark_rooms(std::span<double> light) {
    const double brightest = *std::max_element(light.begin(), light.end());
    for (double& value : light) value = std::max(value, calibrated::dark_room * brightest);
}

std::vector<double> light_by_room(const Stage& stage, const GlobalLight& light) {
    const double mean_light = light.mean_reflected(stage.area);
    if (stage.rooms.count() == 0 || mean_light <= 0) return {};
    std::vector<double> out = mean_by_room(
        stage, light.tree, [&](ElementId e) { return mean(light.reflected[light.numbering.number[e]]) / mean_light; });
    raise_dark_rooms(out);
    return out;
}

std::vector<double> delivered_by_room(const Stage& stage, const ElementFunction& indirect,
                                      const DirectProjection& direct, const Spectrum& direct_weight) {
    if (stage.rooms.count() == 0) return {};
    const auto reflected = [&](const ElementTree& tree, ElementId e, const Spectrum& E) {
        return mean(stage.scene.material(tree.region(e)).reflectance * E);
    };
    const ElementTree& tree = indirect.tree;
    std::vector<double> out = mean_by_room(stage, tree, [&](ElementId e) {
        return reflected(tree, e, indirect.at({e, tree.centre(e)}));
    });
    const std::vector<double> projected = mean_by_room(
        stage, direct.tree, [&](ElementId e) { return reflected(direct.tree, e, direct_weight * direct.fit[e].mean); });
    for (std::size_t room = 0; room < out.size(); ++room) out[room] += projected[room];
    return out;
}

std::vector<double> light_of_bodies(const Stage& stage, const GlobalLight& light, const SceneBodies& bodies,
                                    std::span<const double> light_in) {
    const double mean_light = light.mean_reflected(stage.area);
    std::vector<double> flux(bodies.all.size()), area(flux.size()), least(flux.size());
    for (std::size_t i = 0; i < light.reflected.size(); ++i) {
        const ElementId e = light.numbering.leaves[i];
        const RegionId region = light.tree.region(e);
        if (stage.is_unlit(region)) continue;
        const std::uint32_t body = bodies.of(stage.scene, region);
        area[body] += light.tree.area(e), flux[body] += light.tree.area(e) * mean(light.reflected[i]);
        const double of_room = mean_light * (light_in.empty() ? 1 : light_in[stage.rooms.of(light.tree, e)]);
        least[body] = std::max(least[body], min_body_light * of_room);
    }
    std::vector<double> out(bodies.all.size(), mean_light);
    for (std::size_t body = 0; body < out.size(); ++body)
        if (area[body] > 0) out[body] = std::max(flux[body] / area[body], least[body]);
    return out;
}

namespace {

/// 1 for rooms that have a place on a side that light may reach.
std::vector<char> are_rooms_lit(const Stage& stage) {
    std::vector<char> out(stage.rooms.count());
    // Parts of a piece's edges, derived from rooms, most of whose walls are whole pieces.
    constexpr std::array<double, 3> places{0.1, 0.5, 0.9};
    for (const Piece& piece : stage.lit_pieces())
        for (const double u : places)
            for (const double v : places)
                out[stage.rooms.at(piece.region, piece.patch.at(uniform_in_shape(piece.patch.shape, u, v)))] = 1;
    return out;
}

}  // namespace

std::vector<double> allowed_by_room(const Stage& stage, std::span<const double> light_in, double of_all) {
    std::vector<double> out(light_in.begin(), light_in.end());
    if (out.empty()) return out;
    const std::vector<char> is_lit = are_rooms_lit(stage);
    // squared budget of the rooms that are not capped, and the area share of the others
    double left = of_all, area = 1;
    std::vector<std::size_t> rising(out.size());
    for (std::size_t room = 0; room < out.size(); ++room) rising[room] = room;
    std::stable_sort(rising.begin(), rising.end(), [&](std::size_t a, std::size_t b) { return out[a] < out[b]; });
    for (std::size_t k = 0; k < rising.size(); ++k) {
        const std::size_t room = rising[k];
        if (!is_lit[room]) continue;  // its area is no part of that of the stage
        const double share = stage.rooms.area(room) / stage.area, cap = std::sqrt(left / area);
        if (out[room] >= cap) {
            for (; k < rising.size(); ++k) out[rising[k]] = cap;
            break;
        }
        left -= share * out[room] * out[room], area -= share;
    }
    return out;
}

}  // namespace exitance
