#include "exitance/io/scenes/honeybee/honeybee.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "exitance/io/files/text_lines.hpp"
#include "exitance/io/scenes/honeybee/honeybee_model.hpp"
#include "exitance/io/scenes/honeybee/punched_outline.hpp"
#include "exitance/io/scenes/radiance/rad_materials.hpp"
#include "exitance/scene/add_polygon.hpp"

namespace exitance {
namespace {

class HoneybeeScene {
  public:
    HoneybeeScene(const std::string& path, HoneybeeModel model) : path_(path), model_(std::move(model)) {
        out_.description.file = path;
    }

    ReadScene make() {
        for (const RadPrimitive& modifier : model_.modifiers) materials_.take(modifier, path_, {});
        for (const HoneybeeSheet& sheet : model_.sheets) names_.insert(sheet.name);
        for (const HoneybeeSheet& sheet : model_.sheets) add(sheet);
        SceneDescription& d = out_.description;
        d.materials = std::move(materials_.materials);
        d.cameras = std::move(model_.views);
        out_.findings = std::move(model_.findings);
        std::vector<Finding> more = findings_.take();
        out_.findings.insert(out_.findings.end(), more.begin(), more.end());
        return std::move(out_);
    }

  private:
    void add(const HoneybeeSheet& sheet) {
        if (sheet.modifier == "void" || sheet.modifier == "Void") return;
        if (!materials_.has(sheet.modifier)) {
            findings_.error({path_, 0},
                            fmt::format("the model has no modifier '{}', which '{}' names", shown(sheet.modifier),
                                        shown(sheet.name)),
                            "add it to the radiance modifiers of the model");
            return;
        }
        RadPrimitive surface;
        surface.modifier = sheet.modifier, surface.name = sheet.name;
        const RadMeaning* meaning = materials_.meaning_of(surface, path_);
        if (!meaning || meaning->kind == RadMeaning::Kind::left_out) return;
        const bool shared = !sheet.partner.empty() && names_.count(sheet.partner) > 0;
        const bool is_glass = meaning->kind == RadMeaning::Kind::glass;
        const bool is_sheet = is_glass || materials_.materials[meaning->material].is_diffusing_pane();
        // Light passes the same sheet from both rooms: the first of the two represents both.
        if (shared && is_sheet && !made_.insert(std::min(sheet.name, sheet.partner)).second) return;
        group_ = static_cast<std::uint32_t>(out_.description.groups.size());
        out_.description.groups.push_back(shown(sheet.name));
        for (const HoneybeeOutline& outline : sheet.outlines)
            for (const std::vector<Point>& corners : punched(outline, sheet.openings)) {
                if (is_glass)
                    add_pane(corners, *meaning, sheet);
                else if (meaning->kind == RadMeaning::Kind::emits)
                    add_face(corners, meaning->material);
                else
                    add_sides(corners, meaning->material, shared && !is_sheet ? HoneybeeSides::back : sheet.sides);
            }
    }

    void add_pane(const std::vector<Point>& corners, const RadMeaning& meaning, const HoneybeeSheet& sheet) {
        if (glass_.insert(sheet.modifier).second)
            out_.glazed_by.push_back(fmt::format("glass '{}' ({})", shown(sheet.modifier), path_));
        Pane pane = materials_.glass[meaning.material];
        pane.corners = corners;
        out_.description.panes.push_back(std::move(pane));
        out_.pane_labels.push_back({sheet.modifier, sheet.name});
    }

    void add_face(const std::vector<Point>& corners, std::uint32_t material) {
        SceneDescription::Face& face = add_polygon(out_.description, corners);
        face.material = material, face.group = group_;
    }

    void add_sides(std::vector<Point> corners, std::uint32_t material, HoneybeeSides sides) {
        if (sides == HoneybeeSides::both) add_face(corners, material);
        std::reverse(corners.begin(), corners.end());
        add_face(corners, material);
    }

    const std::string& path_;
    HoneybeeModel model_;
    ReadScene out_;
    RadFindings findings_;
    RadMaterials materials_{findings_};
    std::set<std::string> names_;  ///< Names of all sheets.
    std::set<std::string> made_;   ///< The smaller name of each pair whose common sheet is in the scene.
    std::set<std::string> glass_;  ///< Materials of the panes so far.
    std::uint32_t group_ = 0;
};

}  // namespace

ReadScene read_honeybee(const std::string& path, const HoneybeeChoices& choices) {
    return HoneybeeScene(path, read_honeybee_model(path, choices)).make();
}

}  // namespace exitance
