#pragma once

#include <map>
#include <vector>

#include "exitance/io/scenes/textures/texture_area.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// What a face shows of its material's pictures: how much more or less it reflects and emits than the material, which
/// has the means of whole pictures. 1: as much.
struct ShownColour {
    Spectrum reflectance{1.0}, exitance{1.0};
};

/// A face's part of a picture by the whole picture, a band; 0 where that is black.
/// outline, wrap_s, wrap_t  see TextureArea::mean
Spectrum relative(const TextureArea& picture, std::span<const Vec2> outline, TextureArea::Wrap wrap_s,
                  TextureArea::Wrap wrap_t);

/// Gives faces the colours of their own parts of pictures: faces of a material that show the same colour share a
/// material of their own, named by it ("bricks #a0522d"). Colours are the same within two of the 256 steps of a
/// picture's code, and what the shared material reflects and emits is the mean over its faces, by area; what is within
/// two steps of the material itself stays there.
class TexturedFaces {
  public:
    /// Keeps a reference.
    /// whitest  that no face reflects more than
    TexturedFaces(SceneDescription& description, double whitest) : out_(&description), whitest_(whitest) {}

    void show(std::size_t face, const ShownColour& colour);

    /// Makes the materials. Returns how many faces have got one.
    std::size_t finish();

  private:
    using Key = std::vector<int>;
    struct Sum {
        Spectrum reflectance, exitance;
        double area = 0;
        std::vector<std::size_t> faces;
    };
    SceneDescription* out_;
    double whitest_;
    std::map<Key, Sum> sums_;
};

}  // namespace exitance
