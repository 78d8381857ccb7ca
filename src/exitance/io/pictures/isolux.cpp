#include "exitance/io/pictures/isolux.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/io/pictures/text.hpp"

namespace exitance {
namespace {

constexpr int no_line = -1;

/// A segment of an isoline inside a square of four pixel centres, in pixels, and the index of its step.
struct Segment {
    Vec2 a, b;
    int step;
};

/// Applies marching squares [Lorensen87] to the squares whose corners show the same surface.
std::vector<Segment> find_segments(const Picture& picture, Quantity quantity, const ColourScale& scale) {
    std::vector<Segment> out;
    const auto pixel = [&](int x, int y) -> const Pixel& {
        return picture.pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.size.width) +
                              static_cast<std::size_t>(x)];
    };
    for (int y = 0; y + 1 < picture.size.height; ++y)
        for (int x = 0; x + 1 < picture.size.width; ++x) {
            constexpr int dx[4] = {0, 1, 1, 0}, dy[4] = {0, 0, 1, 1};
            const RegionId region = pixel(x, y).region;
            double value[4];
            bool whole = !region.is_none();
            for (int k = 0; k < 4 && whole; ++k) {
                const Pixel& corner = pixel(x + dx[k], y + dy[k]);
                whole = corner.region == region && !corner.emits();
                value[k] = value_of(corner, quantity);
            }
            if (!whole) continue;
            const auto [lo, hi] = std::minmax({value[0], value[1], value[2], value[3]});
            const auto first = std::upper_bound(scale.steps.begin(), scale.steps.end(), lo);
            for (auto level = first; level != scale.steps.end() && *level <= hi; ++level) {
                Vec2 crossing[4];
                std::size_t count = 0;
                for (int k = 0; k < 4; ++k) {
                    const int n = (k + 1) % 4;
                    if ((value[k] >= *level) == (value[n] >= *level)) continue;
                    const double t = (*level - value[k]) / (value[n] - value[k]);
                    crossing[count++] = {x + 0.5 + std::lerp(dx[k], dx[n], t), y + 0.5 + std::lerp(dy[k], dy[n], t)};
                }
                for (std::size_t k = 0; k + 1 < count; k += 2)
                    out.push_back({crossing[k], crossing[k + 1], static_cast<int>(level - scale.steps.begin())});
            }
        }
    return out;
}

/// Index of the step whose line crosses each pixel.
std::vector<int> lines_of(const std::vector<Segment>& segments, PictureSize size) {
    std::vector<int> lines(size.pixels(), no_line);
    for (const Segment& s : segments) {
        const int x = std::clamp(static_cast<int>(0.5 * (s.a.x + s.b.x)), 0, size.width - 1);
        const int y = std::clamp(static_cast<int>(0.5 * (s.a.y + s.b.y)), 0, size.height - 1);
        lines[static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) + static_cast<std::size_t>(x)] =
            s.step;
    }
    return lines;
}

/// Collects the pixels of the line that contains `from`, in the order of the search, and removes them from `lines`.
std::vector<std::size_t> take_line(std::vector<int>& lines, std::size_t from, PictureSize size) {
    const int step = lines[from];
    std::vector<std::size_t> line{from};
    lines[from] = no_line;
    for (std::size_t next = 0; next < line.size(); ++next) {
        const int x = static_cast<int>(line[next]) % size.width, y = static_cast<int>(line[next]) / size.width;
        for (int v = std::max(y - 1, 0); v <= std::min(y + 1, size.height - 1); ++v)
            for (int u = std::max(x - 1, 0); u <= std::min(x + 1, size.width - 1); ++u) {
                const auto i = static_cast<std::size_t>(v * size.width + u);
                if (lines[i] != step) continue;
                lines[i] = no_line;
                line.push_back(i);
            }
    }
    return line;
}

struct Label {
    int left, top, width, height;
    bool meets(const Label& o) const {
        return left < o.left + o.width && o.left < left + width && top < o.top + o.height && o.top < top + height;
    }
};

double distance(Vec2 p, const Segment& s) {
    const Vec2 edge = s.b - s.a;
    const double length = dot(edge, edge);
    const double t = length > 0 ? std::clamp(dot(p - s.a, edge) / length, 0.0, 1.0) : 0;
    const Vec2 off = p - (s.a + t * edge);
    return std::hypot(off.x, off.y);
}

/// Draws lines `wide` pixels wide with smooth borders: white on dark pixels, dark on bright ones.
void draw_segments(Image& image, const std::vector<Segment>& segments, double wide) {
    std::vector<float> share(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
    for (const Segment& s : segments) {
        const double reach = 0.5 * wide + 0.5;
        const int left = std::max(0, static_cast<int>(std::min(s.a.x, s.b.x) - reach));
        const int right = std::min(image.width - 1, static_cast<int>(std::max(s.a.x, s.b.x) + reach));
        const int top = std::max(0, static_cast<int>(std::min(s.a.y, s.b.y) - reach));
        const int bottom = std::min(image.height - 1, static_cast<int>(std::max(s.a.y, s.b.y) + reach));
        for (int y = top; y <= bottom; ++y)
            for (int x = left; x <= right; ++x) {
                float& covered = share[static_cast<std::size_t>(y * image.width + x)];
                const double here = std::clamp(reach - distance({x + 0.5, y + 0.5}, s), 0.0, 1.0);
                covered = std::max(covered, static_cast<float>(here));
            }
    }
    for (std::size_t i = 0; i < share.size(); ++i) {
        if (share[i] <= 0) continue;
        std::uint8_t* rgb = image.rgb.data() + 3 * i;
        const bool bright = 2 * rgb[0] + 5 * rgb[1] + rgb[2] > 8 * 120;
        for (int c = 0; c < 3; ++c) {
            const double ink = bright ? 0.25 * rgb[c] : 255 - 0.25 * (255 - rgb[c]);
            rgb[c] = static_cast<std::uint8_t>(std::lround(std::lerp(rgb[c], ink, static_cast<double>(share[i]))));
        }
    }
}

}  // namespace

void draw_isolux(Image& image, const Picture& picture, Quantity quantity, const ColourScale& scale,
                 const std::string& caption) {
    constexpr Rgb paper{20, 20, 24}, ink{255, 255, 255};
    const int s = std::max(1, std::min(image.width / 600, image.height / 375)), size = 11 * s;
    const std::vector<Segment> segments = find_segments(picture, quantity, scale);
    draw_segments(image, segments, 1.2 * s);
    std::vector<int> lines = lines_of(segments, picture.size);

    const std::vector<std::string> names = scale.names();
    std::vector<Label> labels{{0, image.height - 16 * s, text_width(caption, size) + 8 * s, 16 * s}};
    const auto write = [&](const Label& label, const std::string& text) {
        fill_rectangle(image, label.left, label.top, label.width, label.height, paper);
        draw_text(image, label.left + 2 * s, label.top + (label.height - 8 * s) / 2, text, size, ink);
    };
    write(labels[0], caption);
    const auto shortest = static_cast<std::size_t>(60 * s);
    for (std::size_t from = 0; from < lines.size(); ++from) {
        if (lines[from] == no_line) continue;
        const std::string& name = names[static_cast<std::size_t>(lines[from])];
        const std::vector<std::size_t> line = take_line(lines, from, picture.size);
        if (line.size() < shortest) continue;
        // Positions to try, as shares of the line; the first free one gets the label.
        for (const double along : {0.5, 0.35, 0.65, 0.2, 0.8}) {
            const auto at = static_cast<int>(line[static_cast<std::size_t>(along * static_cast<double>(line.size()))]);
            const int width = text_width(name, size) + 4 * s, height = 12 * s;
            const Label label{at % image.width - width / 2, at / image.width - height / 2, width, height};
            const bool inside = label.left >= 0 && label.top >= 0 && label.left + width <= image.width &&
                                label.top + height <= image.height;
            const auto meets = [&](const Label& other) { return label.meets(other); };
            if (!inside || std::any_of(labels.begin(), labels.end(), meets)) continue;
            labels.push_back(label);
            write(label, name);
            break;
        }
    }
}

}  // namespace exitance
