#include "exitance/measure/light_maps/curved_borders.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace exitance {
namespace {

constexpr int reach = 2;  ///< Texels from the centre of the fitted square to its sides.
/// RMS deviation from the plane, relative to the mean, above which there is an edge of light. Derived from the bend of
/// light on a mesh of 16 sides per turn with four texels per side, which is 5%.
constexpr double max_deviation = 0.1;
/// Squared product of the two widths of the texels, texels^4: below it the slope is unknown. Derived from a strip one
/// texel wide.
constexpr double min_spread = 0.02;

class BorderFitter {
  public:
    BorderFitter(const Chart::Rectangle& room, std::span<const CurvedTexel> curved, std::span<std::uint32_t> charts,
                 std::span<TexelValues* const> values, LightMap& light)
        : room_(room), curved_(curved), charts_(charts), values_(values), light_(light) {}

    void fit() {
        struct Fitted {
            std::size_t texel;
            std::uint32_t chart;
            std::vector<Spectrum> values;
        };
        std::vector<Fitted> fitted;
        for (int y = room_.y; y < room_.y + room_.height; ++y)
            for (int x = room_.x; x < room_.x + room_.width; ++x) {
                const std::size_t i = light_.index(x, y);
                const bool is_part = is_sample(i) && light_.share[i] < 1;
                if (!is_part && light_.source[i] != LightMap::Source::nothing) continue;
                const std::size_t of = is_part ? i : neighbour(x, y);
                if (of == none) continue;
                find_samples(x, y, chart(of));
                Fitted f{i, chart(of), {}};
                for (const TexelValues* values : values_)
                    if (const std::optional<Spectrum> value = plane_at_centre(*values)) f.values.push_back(*value);
                if (f.values.size() == values_.size()) fitted.push_back(std::move(f));
            }
        for (const Fitted& f : fitted) {
            for (std::size_t v = 0; v < values_.size(); ++v)
                for (std::size_t b = 0; b < bands; ++b)
                    (*values_[v])[f.texel][b] = static_cast<float>(std::max(0.0, f.values[v][b]));
            if (light_.source[f.texel] == LightMap::Source::nothing)
                light_.source[f.texel] = LightMap::Source::extrapolated;
            if (!charts_.empty()) charts_[f.texel] = f.chart;
        }
    }

  private:
    static constexpr std::size_t none = static_cast<std::size_t>(-1);
    /// A texel of the square; its position is relative to the centre of the texel that is fitted.
    struct Sample {
        std::size_t texel;
        double x, y, weight;
    };

    bool is_sample(std::size_t i) const {
        return curved_[i].is_curved && light_.source[i] == LightMap::Source::computed;
    }
    std::uint32_t chart(std::size_t i) const { return charts_.empty() ? 0 : charts_[i]; }
    bool is_inside(int x, int y) const {
        return x >= room_.x && y >= room_.y && x < room_.x + room_.width && y < room_.y + room_.height;
    }

    /// The nearest texel with computed light next to an empty one; none if there is none.
    std::size_t neighbour(int x, int y) const {
        std::size_t found = none;
        int least = 3;
        for (int v = y - 1; v <= y + 1; ++v)
            for (int u = x - 1; u <= x + 1; ++u) {
                const int distance = std::abs(u - x) + std::abs(v - y);
                if (distance < least && is_inside(u, v) && is_sample(light_.index(u, v)))
                    least = distance, found = light_.index(u, v);
            }
        return found;
    }

    void find_samples(int x, int y, std::uint32_t name) {
        samples_.clear();
        for (int v = y - reach; v <= y + reach; ++v)
            for (int u = x - reach; u <= x + reach; ++u) {
                if (!is_inside(u, v)) continue;
                const std::size_t i = light_.index(u, v);
                if (!is_sample(i) || chart(i) != name) continue;
                const double dx = u - x + static_cast<double>(curved_[i].x);
                const double dy = v - y + static_cast<double>(curved_[i].y);
                samples_.push_back({i, dx, dy, static_cast<double>(light_.share[i]) / (1 + dx * dx + dy * dy)});
            }
    }

    /// Weighted least squares of a + b x + c y; returns a.
    std::optional<Spectrum> plane_at_centre(const TexelValues& values) const {
        double W = 0, X = 0, Y = 0, XX = 0, XY = 0, YY = 0;
        Spectrum E, EX, EY;
        const auto value = [&](const Sample& s) {
            Spectrum out;
            for (std::size_t b = 0; b < bands; ++b) out[b] = static_cast<double>(values[s.texel][b]);
            return out;
        };
        for (const Sample& s : samples_) W += s.weight, X += s.weight * s.x, Y += s.weight * s.y;
        if (!(W > 0)) return std::nullopt;
        X /= W, Y /= W;
        for (const Sample& s : samples_) {
            const double x = s.x - X, y = s.y - Y, w = s.weight / W;
            const Spectrum v = w * value(s);
            XX += w * x * x, XY += w * x * y, YY += w * y * y;
            E += v, EX += x * v, EY += y * v;
        }
        const double spread = XX * YY - XY * XY;
        if (!(spread > min_spread)) return std::nullopt;
        const Spectrum slope_x = (YY * EX - XY * EY) / spread, slope_y = (XX * EY - XY * EX) / spread;
        double squares = 0;
        for (const Sample& s : samples_) {
            const double left = mean(value(s) - E - (s.x - X) * slope_x - (s.y - Y) * slope_y);
            squares += s.weight / W * left * left;
        }
        if (std::sqrt(squares) > max_deviation * mean(E)) return std::nullopt;
        return E - X * slope_x - Y * slope_y;
    }

    const Chart::Rectangle room_;
    std::span<const CurvedTexel> curved_;
    std::span<std::uint32_t> charts_;
    std::span<TexelValues* const> values_;
    LightMap& light_;
    std::vector<Sample> samples_;
};

}  // namespace

void fit_curved_borders(const Chart::Rectangle& room, std::span<const CurvedTexel> curved,
                        std::span<std::uint32_t> charts, std::span<TexelValues* const> values, LightMap& light) {
    BorderFitter(room, curved, charts, values, light).fit();
}

}  // namespace exitance
