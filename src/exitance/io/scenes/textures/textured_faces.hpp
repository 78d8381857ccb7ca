#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "exitance/io/scenes/textures/texture_area.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// Statistics per band of the part of a picture that a face shows, relative to the mean of the whole picture.
struct ShownPart {
    Spectrum mean{1.0}, deviation;  ///< RMS deviation from the mean over the face.
    Spectrum lowest{1.0}, highest{1.0};
};

/// The parts that a face shows of its material's two pictures. The material has the means of the whole pictures.
struct ShownColour {
    ShownPart reflectance, exitance;
};

/// Statistics of a face's part of a picture relative to the whole picture; 0 in bands in which that is black. See
/// TextureArea::part() for the parameters.
ShownPart relative(const TextureArea& picture, std::span<const Vec2> outline, TextureArea::Wrap wrap_s,
                   TextureArea::Wrap wrap_t);

/// Gives faces the colours of their own parts of pictures. Faces of a material with equal colours share a new material,
/// named by its colour ("bricks #a0522d"), whose reflectance and exitance are the area-weighted means of its faces.
/// Colours are equal if they differ by at most two of the picture's 256 codes. A face within two codes of its original
/// material keeps it.
class TexturedFaces {
  public:
    /// Keeps a reference to `description`.
    /// whitest  upper limit of the reflectance of faces
    TexturedFaces(SceneDescription& description, double whitest) : out_(&description), whitest_(whitest) {}

    void show(std::size_t face, const ShownColour& colour);

    /// Creates the materials. Returns the number of faces that got a new one.
    std::size_t finish();

    /// Valid after finish(). Per material: RMS deviation of reflectance over its textured faces from its own
    /// reflectance. Materials beyond the end have none.
    const std::vector<Spectrum>& reflectance_deviation() const { return deviation_; }

    /// Valid after finish(). Returns a warning about variation within faces, which is averaged, or nothing. The caller
    /// sets the warning's file and line.
    std::optional<Finding> finding() const;

  private:
    using Key = std::vector<int>;
    struct Sum {
        Spectrum reflectance, exitance, squares;  ///< Sum of squared reflectances.
        double area = 0;
        std::vector<std::size_t> faces;
    };
    /// The face with the largest variation of a quantity relative to its mean.
    struct Steepest {
        double ratio = 0, lowest = 0, highest = 0;
        std::string material;
        std::size_t faces = 0;  ///< Number of faces of the material on which the quantity varies.
    };
    void note(Steepest& steepest, const Spectrum& whole, const ShownPart& part, const std::string& material) const;
    void set_deviation(std::size_t material, const Sum& sum, const Spectrum& mean);
    SceneDescription* out_;
    double whitest_;
    std::map<Key, Sum> sums_;
    std::map<std::uint32_t, Sum> unchanged_;  ///< Keyed by material: faces that keep their material.
    std::vector<Spectrum> deviation_;
    Steepest reflects_, emits_;
};

}  // namespace exitance
