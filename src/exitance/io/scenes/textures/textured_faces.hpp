#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "exitance/io/scenes/textures/texture_parts.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// Gives faces the colours of their own parts of pictures, and cuts those where the colour varies
/// (`cut_textured_faces`). Faces and parts of a material with equal colours share a new material, named by its colour
/// ("bricks #a0522d"), whose reflectance and exitance are the area-weighted means of its faces. Colours are equal if
/// they differ by at most two of the picture's 256 codes. A face within two codes of its original material keeps it.
class TexturedFaces {
  public:
    /// Keeps a reference to `description`.
    /// whitest    upper limit of the reflectance of faces
    /// max_parts  limit on the parts of all patches (a part may consist of several faces); none:
    /// `default_texture_parts`; 0: no face is cut
    TexturedFaces(SceneDescription& description, double whitest, std::optional<std::size_t> max_parts)
        : out_(&description), whitest_(whitest), max_parts_(max_parts), next_trim_(2 * max_varying) {}

    /// Gives a face its colours. If its material emits by a picture, `colours.exitance` must have that picture.
    void show(std::size_t face, FaceColours colours);

    /// Cuts faces and creates the materials. Parts of a face replace it in the description's list of faces.
    void finish();

    /// Valid after finish(). Per material: RMS deviation of reflectance over its textured faces and parts of faces from
    /// its own reflectance. Materials beyond the end have none.
    const std::vector<Spectrum>& reflectance_deviation() const { return deviation_; }

    /// Valid after finish(). Returns a warning about variation within faces and parts, which is averaged, or nothing.
    /// The caller sets the warning's file and line.
    std::optional<Finding> finding() const;
    /// Like finding(), about faces with holes.
    std::optional<Finding> finding_of_holes() const;

  private:
    /// Limit on the faces that are candidates for cuts: memory of about 1 kB each.
    static constexpr std::size_t max_varying = std::size_t(1) << 18;
    using Key = std::vector<int>;
    struct Sum {
        Spectrum reflectance, exitance, squares;  ///< Sums over area, m^2; `squares`: of squared reflectances.
        double area = 0;
        std::vector<std::size_t> faces;
    };
    /// Variation of a quantity within faces and parts.
    struct Variation {
        double area = 0, squares = 0, sum = 0;  ///< Area, area times squared deviation, area times mean.
        std::size_t faces = 0;                  ///< Number of faces and parts within which the quantity varies.
        double largest = 0;  ///< Largest contribution of one face to `squares`; `material` is that of the face.
        double lowest = 0, highest = 0;
        std::string material;

        void add(const ColourRange& range, double of, bool varies, const std::string& name);
    };
    void keep(VaryingFace face);
    /// Decides whether a face with holes stays whole: of each material, the area of faces that stay equals the area
    /// that the pictures cover.
    bool stays(const VaryingFace& face);
    /// Adds a face or a part with its final colour.
    void add(std::size_t face, const PartColour& colour, double area);
    void cut_backs_like_fronts(CutFaces& cut) const;
    void replace_cut_faces();
    void set_deviation(std::size_t material, const Sum& sum, const Spectrum& mean);
    SceneDescription* out_;
    double whitest_;
    std::optional<std::size_t> max_parts_;
    std::vector<VaryingFace> varying_;
    std::map<Key, Sum> sums_;
    std::map<std::uint32_t, Sum> unchanged_;  ///< Per material: sums over the faces that keep their material.
    std::vector<Spectrum> deviation_;
    Variation reflects_, emits_;
    std::size_t cut_faces_ = 0, parts_ = 0;
    std::size_t next_trim_;  ///< Number of varying faces at which those of least effect are dropped.
    /// Faces with holes.
    struct Holes {
        std::size_t faces = 0, uncut = 0;
        double area = 0, misplaced = 0;  ///< m^2
        /// Per material: opaque area omitted so far minus area of holes closed so far, m^2.
        std::map<std::uint32_t, double> balance;
        std::vector<std::uint32_t> before;  ///< Corners of the previous face; the next face may be its back.
        bool before_stays = false;
    } holes_;
};

}  // namespace exitance
