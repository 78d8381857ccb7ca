#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "exitance/io/scenes/textures/texture_area.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// A band of a face's part of a picture, relative to the mean of the whole picture.
struct ShownPart {
    Spectrum mean{1.0}, deviation;  ///< Root mean square deviation from the mean over the face.
    Spectrum lowest{1.0}, highest{1.0};
};

/// The parts of its material's pictures that a face shows. The material has the means of whole pictures.
struct ShownColour {
    ShownPart reflectance, exitance;
};

/// A face's part of a picture relative to the whole picture; 0 where that is black.
/// outline, wrap_s, wrap_t  see TextureArea::part
ShownPart relative(const TextureArea& picture, std::span<const Vec2> outline, TextureArea::Wrap wrap_s,
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

    /// After finish(): the RMS deviation of reflectance from the material's over the faces of every material that show
    /// a picture. Materials beyond the end have none.
    const std::vector<Spectrum>& reflectance_deviation() const { return deviation_; }

    /// After finish(): a warning about variation within faces, which is lost; none where there is none. Its place is
    /// left open.
    std::optional<Finding> finding() const;

  private:
    using Key = std::vector<int>;
    struct Sum {
        Spectrum reflectance, exitance, squares;  ///< Of reflectances.
        double area = 0;
        std::vector<std::size_t> faces;
    };
    /// The face on which a quantity varies most, relative to its mean.
    struct Steepest {
        double ratio = 0, lowest = 0, highest = 0;
        std::string material;
        std::size_t faces = 0;  ///< On which it varies.
    };
    void note(Steepest& steepest, const Spectrum& whole, const ShownPart& part, const std::string& material) const;
    void set_deviation(std::size_t material, const Sum& sum, const Spectrum& mean);
    SceneDescription* out_;
    double whitest_;
    std::map<Key, Sum> sums_;
    std::map<std::uint32_t, Sum> unchanged_;  ///< Of faces that keep their material.
    std::vector<Spectrum> deviation_;
    Steepest reflects_, emits_;
};

}  // namespace exitance
