#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "exitance/base/result.hpp"
#include "exitance/base/vec.hpp"
#include "exitance/io/scenes/textures/texture_mean.hpp"

namespace exitance {

/// A texture as linear light, in a pyramid of resolutions of which the finest has at most 2^22 pixels (2048 x 2048):
/// about 32 MB. A larger picture is reduced by averaging blocks of pixels.
class TextureArea {
  public:
    using Colour = std::array<double, 3>;
    /// Treatment of texture coordinates beyond the picture's borders.
    enum class Wrap : std::uint8_t { repeat, mirror, clamp };
    /// Converts glTF's wrap mode; unknown ones repeat.
    static Wrap wrap_of(int number);

    /// Decodes a picture. `file` is PNG or JPEG, see `decode_texture`.
    static Result<TextureArea> of(std::span<const std::uint8_t> file, const ByteCurve& decode);
    static TextureArea of(const TexturePixels& pixels, const ByteCurve& decode);

    /// Mean of the whole picture.
    Colour mean() const { return mean_; }

    /// Statistics of the part of a picture that a face shows, per channel.
    struct Part {
        Colour mean{};
        Colour deviation{};  ///< RMS deviation from the mean.
        Colour lowest{}, highest{};
    };

    /// Samples the picture at 32 x 32 positions in the outline's bounding box and averages those inside the outline.
    /// Pixels come from the pyramid level whose pixel size is at most the distance of samples, so finer variation is
    /// averaged. The outline is resolved to half that distance; the mean of a triangle with a black and a white half is
    /// accurate to 0.01.
    /// outline  corners of the face in the picture; (0, 0) is the upper left, (1, 1) the lower right
    Part part(std::span<const Vec2> outline, Wrap wrap_s, Wrap wrap_t) const;
    Colour mean(std::span<const Vec2> outline, Wrap wrap_s, Wrap wrap_t) const {
        return part(outline, wrap_s, wrap_t).mean;
    }

    /// Borders of pixels between two texture coordinates, with both ends: of blocks of 2^k x 2^k pixels, or of several
    /// repetitions of the picture, such that there are at most about `max_cells` cells. Cells narrower than a
    /// thousandth of the whole are joined with a neighbour.
    /// along_s  true for coordinates across the picture, false for those down
    std::vector<double> borders(bool along_s, double low, double high, std::size_t max_cells) const;

    /// Mean colours of the cells between `columns` and `rows` (texture coordinates, ascending, at least two), row by
    /// row. Exact for the pixels of the coarsest level whose pixels are not wider than an average cell.
    std::vector<Colour> cell_means(std::span<const double> columns, std::span<const double> rows, Wrap wrap_s,
                                   Wrap wrap_t) const;

    /// Colour at a position, averaged over `size` pixels of the finest level.
    Colour smoothed(const Vec2& place, double size, Wrap wrap_s, Wrap wrap_t) const;
    /// Size of the finest level, pixels.
    double width() const { return static_cast<double>(levels_.front().width); }
    double height() const { return static_cast<double>(levels_.front().height); }

  private:
    struct Level {
        std::size_t width = 0, height = 0;
        /// Size of the picture in pixels of this level. The last column and row may be covered in part.
        double across = 0, down = 0;
        std::vector<std::uint16_t> rgb;  ///< Colours, linear; 65535 is 1.
        Colour at(std::size_t x, std::size_t y) const {
            const std::uint16_t* c = rgb.data() + 3 * (y * width + x);
            return {c[0] / 65535.0, c[1] / 65535.0, c[2] / 65535.0};
        }
    };
    const Level& level_for(const Vec2& step) const;

    Colour mean_{};
    std::vector<Level> levels_;  ///< Levels of resolution, from the finest to the coarsest.
};

}  // namespace exitance
