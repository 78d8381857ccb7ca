#include "exitance/reconstruct/tile_light.hpp"

#include <algorithm>
#include <tuple>

#include "exitance/geometry/polygon.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {
namespace {

/// The tightest octagon around points of a plane, its sides along a frame of the plane and half-way between: its
/// corners counter-clockwise about n. Fewer than three where the points leave no area.
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

constexpr std::uint32_t probing = 4;  ///< Points of a spot that tell whether the others are wanted.

/// Do values differ by so little that more of them would not change their mean?
bool agree(std::span<const Spectrum> values) {
    constexpr double alike = 0.01;
    double lo = HUGE_VAL, hi = 0;
    for (const Spectrum& value : values) lo = std::min(lo, mean(value)), hi = std::max(hi, mean(value));
    return hi - lo <= alike * hi;
}

/// The mean of value(i) over [0, count): of the first few if these agree.
template <class Value>
Spectrum probed_mean(std::uint32_t count, const Value& value) {
    Spectrum values[probing], sum;
    const std::uint32_t few = std::min(count, probing);
    for (std::uint32_t i = 0; i < few; ++i) sum += values[i] = value(i);
    if (few == count || agree(std::span(values, few))) return sum / few;
    for (std::uint32_t i = few; i < count; ++i) sum += value(i);
    return sum / count;
}

}  // namespace

/// What is known of the emitters from everywhere on these spots; false where they are too slender to ask.
bool TileLight::prepare(std::span<const Spot> spots, RegionId region, const ReceiverLight* whole, ReceiverLight& out) {
    const Stage& stage = light_.stage();
    const Normal& n = stage.scene.regions()[region].plane.n;
    Octagon octagon(n);
    for (const Spot& spot : spots)
        for (std::uint32_t i = 0; i < spot.count; ++i) octagon.add(points_[spot.first + i]);
    octagon.corners(outline_);
    if (outline_.empty()) return false;
    if (whole)
        stage.direct.prepare(outline_, *whole, out, visibility_);
    else
        stage.direct.prepare(outline_, n, region, out, visibility_);
    return true;
}

/// Is a spot so small beside its distance from every emitter that direct light is linear over it? E ~ 1 / d^2 over
/// r = d / 30 departs from its tangent by at most (r / d)^2 times a few: less than 1%, and its mean by a fraction.
bool TileLight::looks_small(const Spot& spot, const ReceiverLight& direct, const Point& middle) const {
    constexpr double small = 1.0 / 30;
    double radius_squared = 0;
    for (std::uint32_t i = 0; i < spot.count; ++i)
        radius_squared = std::max(radius_squared, squared_norm(points_[spot.first + i] - middle));
    for (const Beam& beam : direct.beams) {
        const PunctualLight& lamp = light_.solution().scene.lights()[beam.light];
        const double distance = small * norm(lamp.position - middle);
        if (lamp.kind == PunctualLight::Kind::spot) return false;  // its cone may have a sharp edge
        if (!lamp.is_directional() && radius_squared > distance * distance) return false;
    }
    for (const ReceiverLight::Source& source : direct.sources) {
        const DirectLight::Emitter& emitter = light_.stage().direct.emitters()[source.emitter];
        const double distance = small * (norm(emitter.centre - middle) - emitter.radius);
        if (distance <= 0 || radius_squared > distance * distance) return false;
    }
    return true;
}

Spectrum TileLight::elements(const Spot& spot, std::uint32_t i) {
    const Point& x = points_[spot.first + i];
    if (gather_ == 0) return light_.elements(spot.region, x);
    const std::uint64_t key = hash(seed_, static_cast<std::uint64_t>(Stream::gather), spot.pixel, i);
    const Normal& n = light_.stage().scene.regions()[spot.region].plane.n;
    return light_.gathered({x, n}, spot.region, gather_, key, gathering_);
}

/// `direct` is null where nothing could be prepared.
Spectrum TileLight::irradiance(const Spot& spot, const ReceiverLight* direct) {
    const DirectLight& exact = light_.stage().direct;
    const Spectrum share = gather_ > 0 ? Spectrum(1) : light_.exact_share();
    const auto direct_at = [&](const Point& x) {
        if (direct) return share * exact.irradiance(*direct, x, visibility_);
        const Normal& n = light_.stage().scene.regions()[spot.region].plane.n;
        return share * exact.irradiance(x, n, spot.region, visibility_);
    };
    const auto elements_at = [&](std::uint32_t i) { return elements(spot, i); };
    const auto elements_mean = [&] {
        if (gather_ == 0) return probed_mean(spot.count, elements_at);
        Spectrum sum;  // every gather has noise of its own
        for (std::uint32_t i = 0; i < spot.count; ++i) sum += elements_at(i);
        return sum / spot.count;
    };
    if (squared(share) == 0 || (direct && direct->is_dark())) return elements_mean();
    Point middle;
    for (std::uint32_t i = 0; i < spot.count; ++i) middle += points_[spot.first + i] / spot.count;
    if (direct && direct->is_unshadowed() && looks_small(spot, *direct, middle))
        return direct_at(middle) + elements_mean();
    return probed_mean(spot.count, [&](std::uint32_t i) { return direct_at(points_[spot.first + i]); }) +
           elements_mean();
}

void TileLight::evaluate(std::span<const Point> points, std::vector<Spot>& spots) {
    points_ = points;
    const auto key = [](const Spot& s) { return std::tuple(s.region, s.block, s.pixel); };
    std::sort(spots.begin(), spots.end(), [&](const Spot& a, const Spot& b) { return key(a) < key(b); });
    for (std::size_t first = 0, last = 0; first < spots.size(); first = last) {
        while (last < spots.size() && spots[last].region == spots[first].region) ++last;
        const std::span<Spot> of_region = std::span(spots).subspan(first, last - first);
        const RegionId region = spots[first].region;
        const bool known = prepare(of_region, region, nullptr, whole_);
        for (std::size_t begin = 0, end = 0; begin < of_region.size(); begin = end) {
            while (end < of_region.size() && of_region[end].block == of_region[begin].block) ++end;
            const std::span<Spot> of_block = of_region.subspan(begin, end - begin);
            const bool worth = known && !whole_.is_dark() && !whole_.is_unshadowed();
            const bool nearer = worth && prepare(of_block, region, &whole_, part_);
            const ReceiverLight* direct = nearer ? &part_ : known ? &whole_ : nullptr;
            for (Spot& spot : of_block) spot.irradiance = irradiance(spot, direct);
        }
    }
}

}  // namespace exitance
