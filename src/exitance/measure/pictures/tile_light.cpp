#include "exitance/measure/pictures/tile_light.hpp"

#include <algorithm>
#include <ranges>
#include <tuple>

#include "exitance/base/polygon.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {
namespace {

/// The smallest octagon around points of a plane with sides along two axes of the plane and their bisectors. Corners
/// are counter-clockwise about n; fewer than three if the points have no area.
class Octagon {
  public:
    explicit Octagon(const Normal& n) : frame_(n) {}

    void add(const Point& p) {
        const double u = dot(frame_.u, p), v = dot(frame_.v, p);
        if (!begun_) height_ = dot(frame_.n, p), begun_ = true;
        u_.add(u), v_.add(v), sum_.add(u + v), difference_.add(u - v);
    }

    void corners(std::vector<Point>& out) const {
        out.clear();
        const Vec2 at[8] = {
            {std::max(u_.lo, sum_.lo - v_.lo), v_.lo},        {std::min(u_.hi, difference_.hi + v_.lo), v_.lo},
            {u_.hi, std::max(v_.lo, u_.hi - difference_.hi)}, {u_.hi, std::min(v_.hi, sum_.hi - u_.hi)},
            {std::min(u_.hi, sum_.hi - v_.hi), v_.hi},        {std::max(u_.lo, difference_.lo + v_.hi), v_.hi},
            {u_.lo, std::min(v_.hi, u_.lo - difference_.lo)}, {u_.lo, std::max(v_.lo, sum_.lo - u_.lo)}};
        const double size = std::max(u_.hi - u_.lo, v_.hi - v_.lo);
        for (const Vec2& a : at) {
            const Point p = frame_.to_world(a.x, a.y, height_);
            if (out.empty() || norm(p - out.back()) > 1e-6 * size) out.push_back(p);
        }
        while (out.size() > 1 && norm(out.front() - out.back()) <= 1e-6 * size) out.pop_back();
        if (out.size() < 3 || !(norm(area_vector(out)) > 1e-6 * size * size)) out.clear();
    }

  private:
    struct Range {
        double lo = HUGE_VAL, hi = -HUGE_VAL;
        void add(double x) { lo = std::min(lo, x), hi = std::max(hi, x); }
    };
    Frame frame_;
    double height_ = 0;
    bool begun_ = false;
    Range u_, v_, sum_, difference_;
};

/// Number of points of a spot that are evaluated first, to decide whether the others are needed.
constexpr std::uint32_t probing = 4;

bool agree(const Spectrum& a, const Spectrum& b, double difference = TileLight::alike) {
    return std::abs(mean(a) - mean(b)) <= difference * std::max(mean(a), mean(b));
}

/// Mean of value(i) over [0, count): of the first few values if they, added to `rest`, differ little; else of all.
template <class Value>
Spectrum probed_mean(std::uint32_t count, const Spectrum& rest, const Value& value) {
    Spectrum values[probing], sum;
    const std::uint32_t few = std::min(count, probing);
    bool all_agree = true;
    for (std::uint32_t i = 0; i < few; ++i) {
        sum += values[i] = value(i);
        for (std::uint32_t k = 0; k < i; ++k) all_agree &= agree(rest + values[i], rest + values[k]);
    }
    if (few == count || all_agree) return sum / few;
    for (std::uint32_t i = few; i < count; ++i) sum += value(i);
    return sum / count;
}

}  // namespace

TileLight::TileLight(const RadiosityFunction& light, std::uint32_t samples, unsigned gather, std::uint64_t seed,
                     SpotPoints kind, double brightness)
    : light_(light),
      samples_(samples),
      gather_(gather),
      seed_(seed),
      kind_(kind),
      brightness_(brightness),
      direct_share_(gather > 0 ? Spectrum(1) : light.exact_share()) {
    spot_at_.fill(0);
}

/// Sets `outline_` to a convex polygon around spots of one region. Returns false if their area is too small for one.
bool TileLight::outline(std::span<const Spot> spots) {
    Octagon octagon(light_.stage().scene.regions()[spots.front().region].plane.n);
    for (const Spot& spot : spots)
        for (std::uint32_t i = 0; i < spot.count; ++i) octagon.add(points_[spot.first + i]);
    octagon.corners(outline_);
    return !outline_.empty();
}

/// Prepares direct light for a block of spots. Returns false if their area is too small for that.
bool TileLight::prepare(std::span<const Spot> spots, const ReceiverLight& whole, ReceiverLight& out) {
    if (is_stopped() || !outline(spots)) return false;
    light_.stage().direct.prepare(outline_, whole, out, visibility_);
    return true;
}

const ReceiverLight* TileLight::look_at_block(std::span<const Spot> spots, const ReceiverLight* whole,
                                              ReceiverLight& room) {
    const bool worth = whole && !whole->is_dark() && !whole->is_unshadowed();
    return worth && prepare(spots, *whole, room) ? &room : whole;
}

/// Mean of a spot's points.
Point TileLight::centre_of(const Spot& spot) const {
    Point middle;
    for (std::uint32_t i = 0; i < spot.count; ++i) middle += points_[spot.first + i] / spot.count;
    return middle;
}

/// True if a spot is so small compared with its distance from every emitter that direct light is linear over it. E ~ 1
/// / d^2 over r = d / 30 differs from its tangent by at most a few (r / d)^2, less than 1%, and its mean by a fraction
/// of that.
bool TileLight::looks_small(const Spot& spot, const ReceiverLight& known, const Point& middle) const {
    constexpr double small = 1.0 / 30, part_of_step = 1.0 / 8;
    if (!known.behind.empty()) return false;  // a pane may be close to a lamp behind it
    double radius_squared = 0;
    for (std::uint32_t i = 0; i < spot.count; ++i)
        radius_squared = std::max(radius_squared, squared_norm(points_[spot.first + i] - middle));
    for (const Beam& beam : known.beams) {
        const PunctualLight& lamp = light_.solution().scene.lights()[beam.light];
        const double distance = small * norm(lamp.position - middle);
        if (lamp.kind == PunctualLight::Kind::spot) return false;  // the cone of a spotlight may have a sharp edge
        if (!lamp.is_directional() && radius_squared > distance * distance) return false;
    }
    for (const ReceiverLight::Source& source : known.sources) {
        const DirectLight::Emitter& emitter = light_.stage().direct.emitters()[source.emitter];
        // Directed emission has features as narrow as the steps of its table.
        const double angle =
            emitter.radiance.is_directed() ? std::min(small, part_of_step * emitter.radiance.smooth_width()) : small;
        const double distance = angle * (norm(emitter.centre - middle) - emitter.radius);
        if (distance <= 0 || radius_squared > distance * distance) return false;
    }
    return true;
}

/// All light except exact direct light, mean over a spot.
Spectrum TileLight::elements(const Spot& spot) {
    if (is_stopped()) return {};
    if (gather_ == 0 || shown_)
        return probed_mean(spot.count, Spectrum(), [&](std::uint32_t i) {
            const Point& x = points_[spot.first + i];
            return shown_ ? (*shown_)(spot.region, x) : light_.elements(spot.region, x);
        });
    const Normal& n = light_.stage().scene.regions()[spot.region].plane.n;
    Spectrum sum;  // summed over all points of the spot, whose gathers have independent noise
    for (std::uint32_t i = 0; i < spot.count; ++i) {
        const std::uint64_t key = hash(seed_, static_cast<std::uint64_t>(Stream::gather), spot.pixel, i);
        sum += light_.gathered({points_[spot.first + i], n}, spot.region, gather_, key, gathering_);
    }
    return sum / spot.count;
}

/// Direct light, minus that of the mesh where the mesh is integrated.
Spectrum TileLight::direct(const Spot& spot, const ReceiverLight* known, const Point& x) {
    if (is_stopped()) return {};
    const Stage& stage = light_.stage();
    const Spectrum meshed = spot.meshed ? mesh_->at(spot.region, x) : Spectrum();
    if (const std::size_t pixel = pixel_of(spot); known && by_pixel_.is_known[pixel]) {
        const ReceiverLight& shadowed = split_[static_cast<std::size_t>(block_of(spot))].shadowed;
        const bool is_found = shadowed_.is_known[pixel] && (shadowed_.is_interpolated[pixel] || x == centre_of(spot));
        const Spectrum rest = is_found             ? shadowed_.light[pixel]
                              : shadowed.is_dark() ? Spectrum()
                                                   : stage.direct.irradiance(shadowed, x, visibility_);
        return direct_share_ * (by_pixel_.light[pixel] + rest) - meshed;
    }
    if (known) return direct_share_ * stage.direct.irradiance(*known, x, visibility_) - meshed;
    const Normal& n = stage.scene.regions()[spot.region].plane.n;
    return direct_share_ * stage.direct.irradiance(x, n, spot.region, visibility_) - meshed;
}

/// Computes direct light at one point of a spot. Returns true if that is the mean over the spot, so that neither other
/// points nor the mesh are needed.
bool TileLight::first_guess(Spot& spot, const ReceiverLight* known, Spectrum& light) {
    if (squared(direct_share_) == 0 || (known && known->is_dark())) {
        spot.meshed.reset();
        return true;
    }
    const Point middle = centre_of(spot);
    const bool smooth = known && known->is_unshadowed() && looks_small(spot, *known, middle);
    if (smooth || spot.count == 1) spot.meshed.reset();
    // If the pixel also shows other surfaces, the centre may be hidden behind them and have different light.
    light = direct(spot, known, smooth || spot.count == samples_ ? middle : points_[spot.first]);
    return smooth || spot.count == 1;
}

bool TileLight::differs_from_neighbours(std::span<const Spot> spots, std::size_t i) const {
    // Edges of shadows below this difference of neighbours are not visible in pictures for viewing.
    constexpr double unseen_edge = 0.05;  // derived from a shadow edge of five pixels, with steps of 1% between them
    const double difference = interpolation_ > 0 ? unseen_edge : alike;
    int neighbours = 0;
    const auto [x, y] = std::pair(spots[i].x, spots[i].y);
    for (int v = std::max(y - 1, 0); v <= std::min(y + 1, tile_side - 1); ++v)
        for (int u = std::max(x - 1, 0); u <= std::min(x + 1, tile_side - 1); ++u) {
            const std::uint32_t found = spot_at_[static_cast<std::size_t>(v * tile_side + u)];
            if (found == 0 || found == i + 1) continue;
            ++neighbours;
            if (!agree(spots[found - 1].irradiance, spots[i].irradiance, difference)) return true;
        }
    return neighbours < 3;  // a pixel with fewer than three known neighbours is treated as different
}

/// True if light at a square differs from the mean of its two neighbours, horizontally or vertically. If one of them is
/// missing: true if it differs from an existing neighbour.
bool TileLight::bends_between_neighbours(std::span<const Spot> spots, std::size_t i) const {
    const auto [x, y] = std::pair(spots[i].x, spots[i].y);
    const auto light_at = [&](int u, int v) -> const Spectrum* {
        if (std::min(u, v) < 0 || std::max(u, v) >= tile_side) return nullptr;
        const std::uint32_t found = spot_at_[static_cast<std::size_t>(v * tile_side + u)];
        return found == 0 ? nullptr : &spots[found - 1].irradiance;
    };
    for (const auto& [dx, dy] : {std::pair(1, 0), std::pair(0, 1)}) {
        const Spectrum *before = light_at(x - dx, y - dy), *after = light_at(x + dx, y + dy);
        if (!before || !after) return differs_from_neighbours(spots, i);
        if (!agree(0.5 * (*before + *after), spots[i].irradiance)) return true;
    }
    return false;
}

/// Mean of direct light over a whole square with known light at the centre: from five points if these show that light
/// is linear, else from all.
Spectrum TileLight::mirrored_mean(const Spot& spot, const Spectrum& rest, const ReceiverLight* known) {
    const Spectrum middle = spot.irradiance - rest;
    Spectrum pair[2], sum;
    for (std::uint32_t i = 0; i < 4; ++i) pair[i / 2] += 0.5 * direct(spot, known, points_[spot.first + i]);
    if (agree(rest + pair[0], spot.irradiance) && agree(rest + pair[1], spot.irradiance))
        return 0.2 * middle + 0.4 * (pair[0] + pair[1]);
    sum = 2 * (pair[0] + pair[1]);
    for (std::uint32_t i = 4; i < spot.count; ++i) sum += direct(spot, known, points_[spot.first + i]);
    return sum / spot.count;
}

/// Evaluates all spots of one region, block by block.
void TileLight::evaluate_region(std::span<Spot> spots) {
    const ReceiverLight* whole = nullptr;
    if (rays_are_cheaper(spots, whole)) return evaluate_by_rays(spots);
    settled_.assign(spots.size(), 0), rest_.resize(spots.size());
    visit_blocks(spots, [&](std::size_t block, std::size_t begin, std::size_t end) {
        known_[block] = look_at_block(spots.subspan(begin, end - begin), whole, parts_[block]);
    });
    for (std::size_t i = 0; i < spots.size(); ++i) {
        spot_at_[pixel_of(spots[i])] = static_cast<std::uint32_t>(i + 1);
        spots[i].irradiance = spots[i].elements = elements(spots[i]);
    }
    for (SplitLight& split : split_) split.is_split = false;
    visit_blocks(spots, [&](std::size_t block, std::size_t, std::size_t) {
        split_block(block);
        if (split_[block].is_split) fill_open(spots, block);
    });
    if (interpolation_ > 0) fill_shadowed(spots);
    visit_blocks(spots, [&](std::size_t block, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            Spectrum light;
            settled_[i] = first_guess(spots[i], known_[block], light);
            rest_[i] = spots[i].irradiance + spots[i].meshed.value_or(Spectrum());
            spots[i].irradiance = rest_[i] + light;
        }
    });
    const bool squares = kind_ == SpotPoints::mirrored;
    for (std::size_t i = 0; i < spots.size(); ++i)
        settled_[i] |= !(squares && spots[i].count == samples_ ? bends_between_neighbours(spots, i)
                                                               : differs_from_neighbours(spots, i));
    for (std::size_t i = 0; i < spots.size(); ++i) {
        Spot& spot = spots[i];
        spot_at_[pixel_of(spot)] = 0;
        if (settled_[i]) continue;
        const ReceiverLight* known = known_[static_cast<std::size_t>(block_of(spot))];
        if (squares && spot.count == samples_) {
            spot.irradiance = rest_[i] + mirrored_mean(spot, rest_[i], known);
            continue;
        }
        const auto direct_at = [&](std::uint32_t k) { return direct(spot, known, points_[spot.first + k]); };
        spot.irradiance = rest_[i] + probed_mean(spot.count, rest_[i], direct_at);
    }
    for (const Spot& spot : spots) by_pixel_.is_known[pixel_of(spot)] = shadowed_.is_known[pixel_of(spot)] = 0;
}

void TileLight::evaluate(std::span<const Point> points, std::vector<Spot>& spots) {
    points_ = points;
    const auto key = [](const Spot& s) { return std::tuple(s.region, block_of(s), s.pixel); };
    std::sort(spots.begin(), spots.end(), [&](const Spot& a, const Spot& b) { return key(a) < key(b); });
    for (std::size_t first = 0, last = 0; first < spots.size(); first = last) {
        while (last < spots.size() && spots[last].region == spots[first].region) ++last;
        if (is_stopped()) return;
        evaluate_region(std::span(spots).subspan(first, last - first));
    }
}

}  // namespace exitance
