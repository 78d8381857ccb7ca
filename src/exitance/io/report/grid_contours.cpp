#include "exitance/io/report/grid_contours.hpp"

#include <algorithm>
#include <cmath>

namespace exitance {
namespace {

class Contours {
  public:
    Contours(const Picture& picture, Vec2 plan)
        : picture_(picture), cell_{plan.x / picture.size.width, plan.y / picture.size.height} {}

    std::vector<ContourSegment> at(double level) const {
        std::vector<ContourSegment> out;
        for (int y = 0; y + 1 < picture_.size.height; ++y)
            for (int x = 0; x + 1 < picture_.size.width; ++x) add(x, y, level, out);
        return out;
    }

  private:
    const Pixel& pixel(const int* at) const {
        return picture_.pixels[static_cast<std::size_t>(at[1] * picture_.size.width + at[0])];
    }
    double value(const int* at) const { return mean(pixel(at).irradiance); }

    void add(int x, int y, double level, std::vector<ContourSegment>& out) const {
        const int corner[4][2] = {{x, y}, {x + 1, y}, {x + 1, y + 1}, {x, y + 1}};
        for (const auto& c : corner)
            if (pixel(c).front == 0) return;
        Vec2 crossings[4];
        std::size_t count = 0;
        for (int k = 0; k < 4; ++k) {
            const int *p = corner[k], *q = corner[(k + 1) % 4];
            const double a = value(p) - level, b = value(q) - level;
            if ((a >= 0) == (b >= 0)) continue;
            const double s = a / (a - b);
            crossings[count++] = {(p[0] + s * (q[0] - p[0]) + 0.5) * cell_.x,
                                  (p[1] + s * (q[1] - p[1]) + 0.5) * cell_.y};
        }
        for (std::size_t k = 0; k + 1 < count; k += 2) out.push_back({crossings[k], crossings[k + 1]});
    }

    const Picture& picture_;
    Vec2 cell_;
};

}  // namespace

Pixel lit_pixel(double value) {
    Pixel pixel;
    pixel.irradiance = Spectrum(value), pixel.front = 1, pixel.region = RegionId(0);
    return pixel;
}

Picture picture_of_points(const GridLight& light, const std::vector<double>& values) {
    Picture picture{{light.columns, light.rows}, {}};
    for (int row = light.rows - 1; row >= 0; --row)
        for (int column = 0; column < light.columns; ++column) {
            const auto i = static_cast<std::size_t>(row * light.columns + column);
            picture.pixels.push_back(light.is_open[i] ? lit_pixel(values[i]) : Pixel());
        }
    return picture;
}

Picture smooth_picture(const Picture& points, int wanted) {
    const int w = points.size.width, h = points.size.height;
    const int fine = std::max(1, wanted / std::max(w, h));
    Picture out{{w * fine, h * fine}, {}};
    const auto at = [&](int x, int y) -> const Pixel& {
        return points.pixels[static_cast<std::size_t>(std::clamp(y, 0, h - 1) * w + std::clamp(x, 0, w - 1))];
    };
    for (int y = 0; y < out.size.height; ++y)
        for (int x = 0; x < out.size.width; ++x) {
            const double u = (x + 0.5) / fine - 0.5, v = (y + 0.5) / fine - 0.5;
            const int i = static_cast<int>(std::floor(u)), j = static_cast<int>(std::floor(v));
            double sum = 0, weight = 0;
            for (int b = 0; b < 2; ++b)
                for (int a = 0; a < 2; ++a) {
                    const double share = (a == 0 ? i + 1 - u : u - i) * (b == 0 ? j + 1 - v : v - j);
                    if (at(i + a, j + b).front == 0) continue;
                    sum += share * mean(at(i + a, j + b).irradiance), weight += share;
                }
            const bool hidden = at(x / fine, y / fine).front == 0;
            out.pixels.push_back(hidden || weight == 0 ? Pixel() : lit_pixel(sum / weight));
        }
    return out;
}

std::vector<ContourSegment> contour(const Picture& picture, Vec2 plan, double level) {
    return Contours(picture, plan).at(level);
}

}  // namespace exitance
