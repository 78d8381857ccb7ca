#include <fmt/format.h>

#include "exitance/base/words.hpp"
#include "exitance/cli/verbs.hpp"
#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/photometry/glare_table.hpp"
#include "exitance/io/photometry/luminaire_body.hpp"
#include "exitance/io/photometry/photometric_file.hpp"
#include "exitance/io/photometry/polar_diagram.hpp"
#include "exitance/io/scenes/obj/obj_writer.hpp"

namespace exitance {
namespace {

struct Angles {
    BeamSpread c0, c90;
};

Angles angles(const Photometry& p, double share) {
    return {beam_spread(p, {1, 0, 0}, share), beam_spread(p, {0, 1, 0}, share)};
}

const char* name_of(Photometry::Type type) {
    return type == Photometry::Type::c ? "C" : type == Photometry::Type::b ? "B" : "A";
}

std::string number_or_null(std::optional<double> value) {
    return value ? fmt::format("{:.10g}", *value) : "null";
}

std::string findings_json(const Photometry& p, Finding::Kind kind) {
    std::string out;
    for (const Finding& f : p.findings)
        if (f.kind == kind)
            out += fmt::format("{}\n    {{\"file\": {}, \"line\": {}, \"message\": {}}}", out.empty() ? "" : ",",
                               json_text(f.file), f.line, json_text(f.message));
    return out.empty() ? "[]" : "[" + out + "\n  ]";
}

std::string spread_json(const Angles& a) {
    return fmt::format("{{\"c0_c180\": {:.6g}, \"c90_c270\": {:.6g}}}", a.c0.whole(), a.c90.whole());
}

/// Heights of a box's luminous sides in C0 and C90, metres.
Vec2 luminous_sides(const Opening& opening) {
    return {opening.size.z - opening.dark_x, opening.size.z - opening.dark_y};
}

std::string opening_words(const Opening& opening) {
    if (opening.shape == Opening::Shape::point) return "point";
    const Vec3& size = opening.size;
    const Vec2 sides = luminous_sides(opening);
    return fmt::format(
        "{}, {:.4g} m (C0) x {:.4g} m (C90) x {:.4g} m (high){}", exitance::name_of(opening.shape), size.x, size.y,
        size.z,
        sides.x == sides.y ? "" : fmt::format("; luminous sides {:.4g} m (C0), {:.4g} m (C90)", sides.x, sides.y));
}

std::string facts_json(const Photometry& p) {
    const double flux = p.flux();
    std::string keywords;
    for (const auto& [key, text] : p.keywords)
        keywords += fmt::format("{}\n    [{}, {}]", keywords.empty() ? "" : ",", json_text(key), json_text(text));
    const std::optional<double> ratio = p.lamp_lumens ? std::optional(flux / *p.lamp_lumens) : std::nullopt;
    const std::string housing =
        p.housing ? fmt::format("[{:.6g}, {:.6g}, {:.6g}]", p.housing->x, p.housing->y, p.housing->z) : "null";
    return fmt::format(
        "{{\n  \"file\": {},\n  \"format\": {},\n  \"photometric_type\": \"{}\",\n  \"symmetry\": \"{}\",\n"
        "  \"absolute\": {},\n  \"lamps\": {},\n  \"lamp_lumens\": {},\n  \"luminaire_lumens\": {:.10g},\n"
        "  \"upward_lumens\": {},\n  \"efficiency\": {},\n  \"stated_efficiency\": {},\n  \"watts\": {},\n"
        "  \"lumens_per_watt\": {},\n  \"largest_candela\": {:.10g},\n  \"beam_angle\": {},\n  \"field_angle\": {},\n"
        "  \"opening\": {{\"shape\": \"{}\", \"size\": [{:.6g}, {:.6g}, {:.6g}], \"luminous_sides\": [{:.6g}, "
        "{:.6g}]}},\n  \"housing\": {},\n"
        "  \"angles\": {{\"theta\": {}, \"phi\": {}}},\n  \"keywords\": [{}\n  ],\n  \"repairs\": {},\n"
        "  \"warnings\": {}\n}}",
        json_text(p.file), json_text(p.format), name_of(p.type), p.symmetry, p.lamp_lumens ? "false" : "true", p.lamps,
        number_or_null(p.lamp_lumens), flux,
        p.type == Photometry::Type::c ? fmt::format("{:.10g}", p.flux(90, 180)) : "null", number_or_null(ratio),
        number_or_null(p.stated_output_ratio), p.watts > 0 ? fmt::format("{:.6g}", p.watts) : "null",
        p.watts > 0 ? fmt::format("{:.6g}", p.efficacy()) : "null", p.largest(), spread_json(angles(p, 0.5)),
        spread_json(angles(p, 0.1)), exitance::name_of(p.opening.shape), p.opening.size.x, p.opening.size.y,
        p.opening.size.z, luminous_sides(p.opening).x, luminous_sides(p.opening).y, housing, p.theta.size(),
        p.phi.size(), keywords, findings_json(p, Finding::Kind::repair), findings_json(p, Finding::Kind::warning));
}

std::string fact(const char* name, const std::string& text) {
    return fmt::format("{:<18}{}\n", name, text);
}

std::string facts_text(const Photometry& p) {
    const double flux = p.flux();
    const Angles beam = angles(p, 0.5), field = angles(p, 0.1);
    const auto spread = [](const Angles& a) {
        return fmt::format("{:.1f} degrees in C0-C180, {:.1f} in C90-C270", a.c0.whole(), a.c90.whole());
    };
    std::string out = fact("format", fmt::format("{}, type {}, symmetry: {}", p.format, name_of(p.type), p.symmetry)) +
                      fact("luminaire", fmt::format("{:.1f} lm", flux));
    if (p.lamp_lumens)
        out += fact("lamps", fmt::format("{}, {:.1f} lm together", p.lamps, *p.lamp_lumens)) +
               fact("efficiency", fmt::format("{:.1f}%", 100 * flux / *p.lamp_lumens));
    else
        out += fact("lamps", "absolute photometry: their flux is not given");
    if (p.type == Photometry::Type::c)
        out += fact("upward", fmt::format("{:.1f} lm, {:.1f}%", p.flux(90, 180), 100 * p.flux(90, 180) / flux));
    if (p.watts > 0) out += fact("power", fmt::format("{:g} W, {:.1f} lm/W", p.watts, p.efficacy()));
    out += fact("largest intensity", fmt::format("{:.1f} cd", p.largest())) + fact("beam angle (50%)", spread(beam)) +
           fact("field angle (10%)", spread(field)) + fact("opening", opening_words(p.opening));
    if (p.housing)
        out += fact("housing", fmt::format("{:.4g} x {:.4g} x {:.4g} m", p.housing->x, p.housing->y, p.housing->z));
    for (const auto& [key, text] : p.keywords)
        if (!key.empty() && !text.empty()) out += fact(key.c_str(), " " + text);
    return out;
}

/// The luminous opening as a scene of diffuse emitters with the flux of the luminaire.
SceneDescription opening_scene(const Photometry& p) {
    SceneDescription scene;
    scene.file = p.file;
    scene.groups.push_back("opening");
    for (const LuminaireBody::Face& face : make_luminaire_body(p).faces) {
        const Spectrum exitance(face.exitance);
        auto material = static_cast<std::uint32_t>(scene.materials.size());
        for (std::uint32_t m = 0; m < scene.materials.size(); ++m)
            if (scene.materials[m].exitance == exitance) material = m;
        if (material == scene.materials.size())
            scene.materials.push_back(
                {face.exitance > 0 ? fmt::format("opening_{}", material) : "dark", Spectrum(), exitance});
        SceneDescription::Face& out = scene.faces.emplace_back();
        out.material = material;
        for (const Point& corner : face.corners) {
            out.corners.push_back(static_cast<std::uint32_t>(scene.points.size()));
            scene.points.push_back(corner);
        }
    }
    return scene;
}

}  // namespace

/// Runs `exitance luminaire FILE [-o DIAGRAM.svg] [-o OPENING.obj] [-o UGR.csv]`.
ExitCode run(const LuminaireArguments& arguments, Terminal& terminal) {
    for (const std::string& output : arguments.outputs)
        if (ending(output) != ".svg" && ending(output) != ".obj" && ending(output) != ".csv")
            return terminal.fail({ErrorCode::usage,
                                  "is written as .svg (polar diagram), .obj (opening) or .csv (table of UGR)", output,
                                  "name it something.svg"});
    const Result<Photometry> p = load_photometry(arguments.file);
    if (!p) return terminal.fail(p.error());
    if (!arguments.json) terminal.show(p->findings);
    terminal.print(arguments.json ? facts_json(*p) : facts_text(*p));
    for (const std::string& output : arguments.outputs) {
        const std::string end = ending(output);
        const Result<void> written = end == ".svg"   ? write_file(output, polar_diagram(*p))
                                     : end == ".csv" ? write_file(output, glare_table_csv(make_glare_table(*p)))
                                                     : write_obj(opening_scene(*p), output);
        if (!written) return terminal.fail(written.error());
    }
    return ExitCode::done;
}

}  // namespace exitance
