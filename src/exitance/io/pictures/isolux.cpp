#include "exitance/io/pictures/isolux.hpp"

#include <algorithm>

#include "exitance/io/pictures/bitmap_font.hpp"

namespace exitance {
namespace {

constexpr int no_line = -1;

/// The step that light passes between a pixel and its right or lower neighbour, for every pixel.
std::vector<int> find_lines(const Picture& picture, const ColourScale& scale) {
    const auto below = [&](const Pixel& pixel) {  // how many steps lie below its light
        const double value = value_of(pixel, Quantity::illuminance);
        return static_cast<int>(std::upper_bound(scale.steps.begin(), scale.steps.end(), value) - scale.steps.begin());
    };
    std::vector<int> steps_below(picture.pixels.size());
    std::transform(picture.pixels.begin(), picture.pixels.end(), steps_below.begin(), below);
    const auto width = static_cast<std::size_t>(picture.size.width);
    std::vector<int> lines(picture.pixels.size(), no_line);
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const auto compare = [&](std::size_t other) {
            const Pixel &a = picture.pixels[i], &b = picture.pixels[other];
            if (a.region.is_none() || a.region != b.region || a.emits() || steps_below[i] == steps_below[other]) return;
            lines[i] = std::max(steps_below[i], steps_below[other]) - 1;
        };
        if ((i + 1) % width != 0) compare(i + 1);
        if (i + width < lines.size()) compare(i + width);
    }
    return lines;
}

/// The pixels of the line through one pixel, in the order in which they are reached; takes them off `lines`.
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

/// Lines `wide` pixels wide: white on what is dark, dark on what is bright.
void draw_lines(Image& image, const std::vector<int>& lines, int wide) {
    std::vector<bool> marked(lines.size());
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const int x = static_cast<int>(i) % image.width, y = static_cast<int>(i) / image.width;
        for (int v = y; lines[i] != no_line && v < std::min(y + wide, image.height); ++v)
            for (int u = x; u < std::min(x + wide, image.width); ++u)
                marked[static_cast<std::size_t>(v * image.width + u)] = true;
    }
    for (std::size_t i = 0; i < marked.size(); ++i) {
        if (!marked[i]) continue;
        std::uint8_t* rgb = image.rgb.data() + 3 * i;
        const bool bright = 2 * rgb[0] + 5 * rgb[1] + rgb[2] > 8 * 120;
        for (int c = 0; c < 3; ++c) rgb[c] = static_cast<std::uint8_t>(bright ? rgb[c] / 4 : 255 - (255 - rgb[c]) / 4);
    }
}

}  // namespace

void draw_isolux(Image& image, const Picture& picture, const ColourScale& scale) {
    constexpr Rgb paper{20, 20, 24}, ink{255, 255, 255};
    const int s = std::max(1, std::min(image.width / 600, image.height / 375));
    std::vector<int> lines = find_lines(picture, scale);
    draw_lines(image, lines, s);

    const std::vector<std::string> names = scale.names();
    const std::string caption = "lines illuminance lx";
    std::vector<Label> labels{{0, image.height - 14 * s, text_width(caption, s) + 8 * s, 14 * s}};
    const auto write = [&](const Label& label, const std::string& text) {
        fill_rectangle(image, label.left, label.top, label.width, label.height, paper);
        draw_text(image, label.left + 2 * s, label.top + 2 * s, text, s, ink);
    };
    write(labels[0], caption);
    const auto shortest = static_cast<std::size_t>(60 * s);
    for (std::size_t from = 0; from < lines.size(); ++from) {
        if (lines[from] == no_line) continue;
        const std::string& name = names[static_cast<std::size_t>(lines[from])];
        const std::vector<std::size_t> line = take_line(lines, from, picture.size);
        if (line.size() < shortest) continue;
        for (const double along : {0.5, 0.35, 0.65, 0.2, 0.8}) {  // the first place that is free
            const auto at = static_cast<int>(line[static_cast<std::size_t>(along * static_cast<double>(line.size()))]);
            const int width = text_width(name, s) + 4 * s, height = 11 * s;
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
