#include "exitance/cli/view/view_requests.hpp"

#include "exitance/cli/json_output.hpp"
#include "exitance/cli/view/view_share.hpp"
#include "exitance/io/export/viewer_data.hpp"
#include "exitance/io/export/viewer_part.hpp"

namespace exitance {
namespace {

using Parameters = ViewServer::Parameters;

ViewAnswer json_answer(std::string body) {
    return {200, "application/json", std::move(body)};
}

/// Returns the answer to a request whose changes of light do not fit.
ViewAnswer refusal(const Error& error) {
    return {400, "text/plain", error.message + " " + error.hint};
}

/// Returns a part of the elements in a layer, or only its light.
ViewAnswer answer_part(const Viewed& v, const Parameters& parameters) {
    const auto part = view_numbers(parameters, "part", 1);
    ViewerLayer layer{};
    if (!find_viewer_layer(view_text(parameters, "layer"), layer) || !part || (*part)[0] < 0 ||
        (*part)[0] >= static_cast<double>(viewer_part_count(v.solution, layer)))
        return view_misunderstood;
    const auto number = static_cast<std::size_t>((*part)[0]);
    const RadiosityFunction* light = layer == ViewerLayer::raw ? &v.light() : nullptr;
    return {200, "application/octet-stream",
            view_text(parameters, "only") == "light" ? viewer_part_light(v.solution, layer, number, light)
                                                     : viewer_part(v.solution, layer, number, light)};
}

/// Returns the light at `at=X,Y,Z,NX,NY,NZ`.
ViewAnswer answer_point(const Viewed& v, const Parameters& parameters) {
    const auto at = view_numbers(parameters, "at", 6);
    if (!at) return view_misunderstood;
    const std::vector<double>& n = *at;
    const Vec3 normal{n[3], n[4], n[5]};
    if (!(norm(normal) > 0)) return view_misunderstood;
    return json_answer(viewer_point_json(v.light(), {{n[0], n[1], n[2]}, normalized(normal)}));
}

/// Returns the light along the line `at=X,Y,Z,X,Y,Z,NX,NY,NZ`, from the first point to the second.
ViewAnswer answer_line(const Viewed& v, const Parameters& parameters, const LightUnit& unit) {
    constexpr std::size_t points = 129;
    const auto at = view_numbers(parameters, "at", 9);
    if (!at) return view_misunderstood;
    const std::vector<double>& n = *at;
    const Vec3 normal{n[6], n[7], n[8]};
    if (!(norm(normal) > 0)) return view_misunderstood;
    return json_answer(
        viewer_line_json(v.light(), {n[0], n[1], n[2]}, {n[3], n[4], n[5]}, normalized(normal), points, unit));
}

}  // namespace

void serve_light(ViewServer& server, const Gallery& gallery, ViewFrames& frames, ViewChanges& changes,
                 const ViewUnits& units) {
    const auto with_light = [&gallery, &changes](auto answer) {
        return [&gallery, &changes, answer](const Parameters& parameters) -> ViewAnswer {
            const bool is_other = view_text(parameters, "of") == "other";
            const Viewed* viewed = is_other ? gallery.other() : gallery.newest();
            if (!viewed) return view_absent;
            if (is_other || !changes.are_asked_for(parameters)) return answer(*viewed, parameters);
            const auto changed = changes.find(*viewed, parameters);
            return changed ? answer(**changed, parameters) : refusal(changed.error());
        };
    };
    server.get("/groups", with_light([&changes](const Viewed& v, const Parameters&) {
                   return changes.read_groups([&](const LightGroups& groups) {
                       return json_answer(light_groups_json(groups, v.solution.scene));
                   });
               }));
    server.get("/data/scene", with_light([units](const Viewed& v, const Parameters&) {
                   return json_answer(viewer_scene_json(v.solution, v.camera, units(v.solution.scene)));
               }));
    server.get("/data/part", with_light(answer_part));
    server.get("/data/frame", with_light([&frames](const Viewed& v, const Parameters& parameters) {
                   return frames.take(v.light(), parameters);
               }));
    server.get("/data/point", with_light(answer_point));
    server.get("/data/line", with_light([units](const Viewed& v, const Parameters& parameters) {
                   return answer_line(v, parameters, units(v.solution.scene));
               }));
}

Result<std::string> share_page(const std::string& page, const Viewed& facts, const Viewed& light, const LightUnit& unit,
                               const std::string& views) {
    std::vector<std::string> parts;
    for (std::size_t i = 0; i < viewer_part_count(light.solution, ViewerLayer::exported); ++i)
        parts.push_back(viewer_part(light.solution, ViewerLayer::exported, i));
    return make_shared_page(page, {viewer_scene_json(facts.solution, facts.camera, unit), parts, views});
}

void serve_share(ViewServer& server, const Gallery& gallery, ViewChanges& changes, const ViewUnits& units,
                 const std::string& page) {
    server.get("/share", [&gallery, &changes, units, page](const Parameters& parameters) -> ViewAnswer {
        const Viewed* viewed = gallery.newest();
        if (!viewed) return view_absent;
        std::shared_ptr<const Viewed> changed;
        if (changes.are_asked_for(parameters)) {
            const auto found = changes.find(*viewed, parameters);
            if (!found) return refusal(found.error());
            changed = *found;
        }
        const LightUnit unit = units(viewed->solution.scene);
        const Result<std::string> shared = share_page(page, *viewed, changed ? *changed : *viewed, unit, "[]");
        if (!shared) return {500, "text/plain", shared.error().message};
        return {200, "text/html; charset=utf-8", *shared};
    });
}

}  // namespace exitance
