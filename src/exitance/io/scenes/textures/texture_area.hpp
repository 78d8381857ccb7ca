#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "exitance/base/result.hpp"
#include "exitance/base/vec.hpp"
#include "exitance/io/scenes/textures/texture_mean.hpp"

namespace exitance {

/// A picture that faces take their colour from, as linear light, held at up to 2048 x 2048 pixels and at half, a
/// quarter ... of that: some 32 MB. A larger picture is held reduced, each pixel by the mean of those it stands for.
class TextureArea {
  public:
    using Colour = std::array<double, 3>;
    /// How places go beyond the picture's borders.
    enum class Wrap : std::uint8_t { repeat, mirror, clamp };
    /// By glTF's number; what is none repeats.
    static Wrap wrap_of(int number);

    /// file  PNG or JPEG, see `decode_texture`
    static Result<TextureArea> of(std::span<const std::uint8_t> file, const ByteCurve& decode);
    static TextureArea of(const TexturePixels& pixels, const ByteCurve& decode);

    /// Of the whole picture.
    Colour mean() const { return mean_; }

    /// The part of a picture that a face shows, by channel.
    struct Part {
        Colour mean{};
        Colour deviation{};  ///< Root mean square deviation from the mean.
        Colour lowest{}, highest{};
    };

    /// Samples the pixels at 32 x 32 places of the part's bounding box, of which those inside the outline count. The
    /// pixels are of a size between neighbouring places, so that none is skipped: variation finer than that is averaged
    /// out. The border is known to half a place, and the mean of two halves of a triangle, one black and one white, to
    /// a hundredth.
    /// outline  the face's corners in the picture; (0, 0) is its upper left, (1, 1) its lower right
    Part part(std::span<const Vec2> outline, Wrap wrap_s, Wrap wrap_t) const;
    Colour mean(std::span<const Vec2> outline, Wrap wrap_s, Wrap wrap_t) const {
        return part(outline, wrap_s, wrap_t).mean;
    }

    /// The colour at a place, smoothed over `size` pixels of what is held.
    Colour smoothed(const Vec2& place, double size, Wrap wrap_s, Wrap wrap_t) const;
    /// Pixels that are held.
    double width() const { return static_cast<double>(levels_.front().width); }
    double height() const { return static_cast<double>(levels_.front().height); }

  private:
    struct Level {
        std::size_t width = 0, height = 0;
        std::vector<std::uint16_t> rgb;  ///< Linear, 65535 is 1.
        Colour at(std::size_t x, std::size_t y) const {
            const std::uint16_t* c = rgb.data() + 3 * (y * width + x);
            return {c[0] / 65535.0, c[1] / 65535.0, c[2] / 65535.0};
        }
    };
    const Level& level_for(const Vec2& step) const;

    Colour mean_{};
    std::vector<Level> levels_;  ///< The finest first.
};

}  // namespace exitance
