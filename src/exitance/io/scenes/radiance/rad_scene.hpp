#pragma once

#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "exitance/io/scenes/obj/obj.hpp"
#include "exitance/io/scenes/radiance/rad_emission.hpp"

namespace exitance {

/// A text being read, and the transform and options with which it was included.
struct RadCall {
    const std::string* name;  ///< Path of the file, or a description of the command that printed the text.
    Affine to_world;
    std::string prefix;
    std::string material;  ///< Material that replaces those of all surfaces; empty: they keep their own.
    int first_line = 0;    ///< Offset of the file's lines in SceneLines.
    int command_line = 0;  ///< SceneLines number of the command that printed the text; 0 for files.
    std::size_t depth = 0;
};

/// Collects the surfaces, panes and distant lights of Radiance's primitives in a scene.
class RadScene {
  public:
    /// `root`: path of the root file being read. All arguments must outlive the object.
    RadScene(ReadScene& out, RadFindings& findings, const std::string& root)
        : out_(out), findings_(findings), emission_(materials_, findings, root) {}

    /// Adds a primitive. Modifiers are kept for later primitives.
    void take(RadPrimitive p, const RadCall& call);
    /// Adds to the bytes of all texts. The number of faces is limited in proportion to them.
    void count_bytes(std::size_t bytes) { bytes_ += bytes; }
    /// Moves the materials to the scene. Without errors, replaces a sphere of light around the whole scene by a sky.
    void finish();
    /// True if `finish` has replaced a sphere.
    bool opened() const { return opened_; }

  private:
    void take_surface(const RadPrimitive& p, const RadCall& call);
    void take_source(const RadPrimitive& p, const RadCall& call);
    void note_patterns(const RadMeaning& meaning);
    void open_up();

    ReadScene& out_;
    RadFindings& findings_;
    RadMaterials materials_{findings_};
    RadEmission emission_;
    std::unordered_map<std::string, std::uint32_t> groups_;
    std::size_t bytes_ = 0;
    /// Spheres that emit inwards without a directional distribution, as ranges of faces.
    struct Bubble {
        std::size_t first = 0, last = 0;
        std::uint32_t material = 0;
    };
    std::vector<Bubble> bubbles_;
    bool opened_ = false;
    std::set<std::string> glass_names_;  ///< Modifiers of the panes so far.
};

}  // namespace exitance
