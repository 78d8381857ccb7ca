#include "exitance/scene/sky/picture_suns.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "exitance/scene/sky/picture_pixels.hpp"

namespace exitance {
namespace {

constexpr std::size_t max_suns = 16;
constexpr int max_candidates = 64;
/// Share of all directions whose radiance is not part of any spot. Derived from the sun with its aureole, which fills
/// less than a cone of 25 degrees, a twentieth of all directions.
constexpr double plain_share = 0.95;
/// Radiance of a spot's maximum over the mean of those directions. Derived from clear skies without the sun's disc,
/// which are 20 times brighter beside the sun than on average.
constexpr double min_contrast = 30;
/// Radiance at the border of a spot over that of its maximum. Derived from the limb of the sun, which has 0.3 of the
/// radiance of its middle, and from the blur of lenses.
constexpr double border_share = 1.0 / 20;
/// Solid angle of the largest spot, sr. Derived from a cone of 5 degrees: larger ones cast soft shadows, for which the
/// cells of a picture are fine enough.
constexpr double max_solid_angle = 0.0239;
/// Share of the picture's light below which a spot stays in the picture. Derived from the accuracy of a solve, 1%.
constexpr double min_flux_share = 0.001;

/// Pixels of a picture, connected across its left and right ends and across the poles.
class SpotFinder {
  public:
    SpotFinder(DirectionalPicture& picture, double rotation)
        : picture_(picture), at_(picture, rotation), brightness_(picture.width * picture.height), seen_(size(), 0) {
        for (std::size_t p = 0; p < size(); ++p) {
            double sum = 0;
            for (std::size_t b = 0; b < bands; ++b) sum += picture.radiance[p * bands + b];
            brightness_[p] = static_cast<float>(sum / static_cast<double>(bands));
        }
        measure();
    }

    std::vector<DistantLight::Disc> take() {
        std::vector<DistantLight::Disc> out;
        for (int i = 0; i < max_candidates && out.size() < max_suns; ++i) {
            const std::size_t peak = brightest_unseen();
            if (peak == size() || !(brightness_[peak] > min_contrast * plain_mean_)) break;
            if (find_spot(peak)) take_spot(out);
        }
        return out;
    }

  private:
    std::size_t size() const { return brightness_.size(); }
    std::size_t row(std::size_t p) const { return p / picture_.width; }

    /// Computes the light of all directions and the mean radiance of the dimmest ones, by a histogram of octaves.
    void measure() {
        constexpr int steps = 16, octaves = 256;  // steps per octave, and the number of octaves of single precision
        std::vector<double> solid_angle(steps * octaves), light(steps * octaves);
        for (std::size_t p = 0; p < size(); ++p) {
            const double dw = at_.solid_angle(row(p)), v = brightness_[p];
            const double place = v > 0 ? steps * (std::log2(v) + octaves / 2.0) : 0;
            const auto bin = static_cast<std::size_t>(std::clamp(place, 0.0, steps * octaves - 1.0));
            solid_angle[bin] += dw, light[bin] += dw * v;
            flux_ += dw * v;
        }
        double area = 0, sum = 0;
        for (std::size_t bin = 0; bin < light.size(); ++bin) {
            if (area > 0 && area + solid_angle[bin] > plain_share * 4 * pi) break;
            area += solid_angle[bin], sum += light[bin];
        }
        plain_mean_ = sum / area;
    }

    std::size_t brightest_unseen() const {
        std::size_t best = size();
        for (std::size_t p = 0; p < size(); ++p)
            if (!seen_[p] && (best == size() || brightness_[p] > brightness_[best])) best = p;
        return best;
    }

    /// Returns the eight neighbours of a pixel.
    std::array<std::size_t, 8> neighbours(std::size_t p) const {
        const std::size_t w = picture_.width, r = row(p), c = p % w;
        std::array<std::size_t, 8> out{};
        std::size_t next = 0;
        for (int dr = -1; dr <= 1; ++dr)
            for (std::size_t dc : {w - 1, std::size_t(0), std::size_t(1)}) {
                if (dr == 0 && dc == 0) continue;
                const bool over_pole = (dr < 0 && r == 0) || (dr > 0 && r + 1 == picture_.height);
                const std::size_t to = dr < 0 ? (over_pole ? r : r - 1) : dr > 0 ? (over_pole ? r : r + 1) : r;
                out[next++] = to * w + (c + dc + (over_pole ? w / 2 : 0)) % w;
            }
        return out;
    }

    /// Collects the pixels of the spot around `peak`. Returns false if it is too large or was part of another one.
    bool find_spot(std::size_t peak) {
        const double least = std::max(border_share * brightness_[peak], plain_mean_);
        spot_ = {peak}, seen_[peak] = 1;
        double solid_angle = 0;
        bool is_free = true;
        for (std::size_t i = 0; i < spot_.size(); ++i) {
            solid_angle += at_.solid_angle(row(spot_[i]));
            for (const std::size_t p : neighbours(spot_[i])) {
                if (!(brightness_[p] >= least)) continue;
                if (!seen_[p]) seen_[p] = 1, spot_.push_back(p);
            }
            if (solid_angle > max_solid_angle) is_free = false;
        }
        return is_free;
    }

    /// Returns the mean radiance of the pixels around the spot, over a width that grows with its size.
    Spectrum surroundings() const {
        std::vector<std::size_t> ring = spot_;
        std::vector<std::size_t> inside = spot_;
        std::sort(inside.begin(), inside.end());
        const auto rounds = 1 + static_cast<int>(std::sqrt(static_cast<double>(spot_.size())) / 4);
        for (int i = 0; i < rounds; ++i) {
            const std::size_t end = ring.size();
            for (std::size_t k = 0; k < end; ++k)
                for (const std::size_t p : neighbours(ring[k])) ring.push_back(p);
            std::sort(ring.begin(), ring.end());
            ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
        }
        Spectrum sum;
        double area = 0;
        for (const std::size_t p : ring) {
            if (std::binary_search(inside.begin(), inside.end(), p)) continue;
            const double dw = at_.solid_angle(row(p));
            area += dw;
            for (std::size_t b = 0; b < bands; ++b) sum[b] += dw * picture_.radiance[p * bands + b];
        }
        return area > 0 ? sum / area : Spectrum();
    }

    /// Moves the spot's radiance above its surroundings into a disc, unless its light is negligible.
    void take_spot(std::vector<DistantLight::Disc>& out) {
        const Spectrum around = surroundings();
        std::array<Vec3, bands> moments{};
        Vec3 moment;
        double sum = 0, squares = 0;
        for (const std::size_t p : spot_) {
            const double dw = at_.solid_angle(row(p));
            const Vec3 directions = at_.moment(row(p), p % picture_.width);
            double excess = 0;
            for (std::size_t b = 0; b < bands; ++b) {
                const double e = std::max(0.0, picture_.radiance[p * bands + b] - around[b]);
                moments[b] += e * directions;
                excess += e / static_cast<double>(bands);
            }
            moment += excess * directions, sum += excess * dw, squares += excess * excess * dw;
        }
        if (!(sum > min_flux_share * flux_)) return;
        DistantLight::Disc disc;
        disc.towards = normalized(moment);
        disc.half_angle = std::acos(1 - std::min(sum * sum / squares, max_solid_angle) / (2 * pi));
        for (std::size_t b = 0; b < bands; ++b) disc.irradiance[b] = std::max(0.0, dot(moments[b], disc.towards));
        out.push_back(disc);
        for (const std::size_t p : spot_)
            for (std::size_t b = 0; b < bands; ++b) {
                float& value = picture_.radiance[p * bands + b];
                value = std::min(value, static_cast<float>(around[b]));
            }
    }

    DirectionalPicture& picture_;
    PicturePixels at_;
    std::vector<float> brightness_;  ///< Mean over bands, as the picture was.
    std::vector<std::uint8_t> seen_;
    std::vector<std::size_t> spot_;
    double flux_ = 0, plain_mean_ = 0;
};

}  // namespace

std::vector<DistantLight::Disc> take_suns(DirectionalPicture& picture, double rotation) {
    return SpotFinder(picture, rotation).take();
}

}  // namespace exitance
