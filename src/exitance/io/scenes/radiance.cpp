#include "exitance/io/scenes/radiance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "exitance/geometry/polygon.hpp"
#include "exitance/io/files/text_lines.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/scenes/rad_emission.hpp"
#include "exitance/io/scenes/rad_shapes.hpp"
#include "exitance/io/scenes/xform.hpp"

namespace exitance {
namespace {

constexpr std::size_t most_copies = 100'000, deepest = 16;

/// Where a file stands among those that call it.
struct Call {
    const std::string* file;
    Affine to_world;
    std::string prefix;
    int line_in_scene = 0;  ///< Of the command in the scene's own file; 0 in that file.
    std::size_t depth = 0;
};

Normal normal_of(const SceneDescription::Face& face, const std::vector<Point>& points) {
    std::vector<Point> corners;
    for (const std::uint32_t c : face.corners) corners.push_back(points[c]);
    const Vec3 area = area_vector(corners);
    return norm(area) > 0 ? normalized(area) : Normal{0, 0, 1};
}

class RadianceReader {
  public:
    explicit RadianceReader(const std::string& path) : path_(path) { out_.description.file = path; }
    ReadScene read();

  private:
    void read_file(const std::string& path, std::string_view text, const Call& call);
    void run_command(const std::string& command, int line, const Call& call);
    void take(RadPrimitive p, const Call& call);
    void take_surface(const RadPrimitive& p, const Call& call);
    void take_source(const RadPrimitive& p, const Call& call);
    void note_patterns(const RadMeaning& meaning);

    const std::string& path_;
    ReadScene out_;
    RadFindings findings_;
    RadMaterials materials_{findings_};
    RadEmission emission_{materials_, findings_, path_};
    std::unordered_map<std::string, std::string> texts_;  ///< Files that commands name, read once.
    std::unordered_map<std::string, std::uint32_t> groups_;
    std::vector<const std::string*> open_;  ///< Files being read, which may not call themselves.
    std::size_t copies_ = 0, bytes_ = 0;
};

/// Patterns on what reflects.
void RadianceReader::note_patterns(const RadMeaning& meaning) {
    if (meaning.pattern_count == 0) return;
    const RadPattern& pattern = materials_.patterns[meaning.pattern];
    findings_.note("patterns and textures", {pattern.file, pattern.primitive.line});
}

void RadianceReader::take_surface(const RadPrimitive& p, const Call& call) {
    const std::string& file = *call.file;
    const RadMeaning* meaning = materials_.meaning_of(p, file);
    const std::optional<RadShape> shape = meaning ? rad_shape(p, file, findings_) : std::nullopt;
    if (!shape || meaning->kind == RadMeaning::Kind::left_out) return;
    const bool emits = meaning->kind == RadMeaning::Kind::emits;
    if (!emits) note_patterns(*meaning);
    auto& d = out_.description;
    // A line of text can ask for any number of copies. Most scenes have no more than these.
    if (const std::size_t most = 300'000 + bytes_ / 20; d.faces.size() + 2 * shape->facets.size() > most) {
        if (!findings_.failed())
            findings_.error({file, p.line}, fmt::format("copies make more than {} faces", most),
                            "write the copies to a file with Radiance's own xform, and read that");
        return;
    }
    const std::string name = call.prefix + shown(p.name);
    const auto [group, is_new] = groups_.try_emplace(name, static_cast<std::uint32_t>(d.groups.size()));
    if (is_new) d.groups.push_back(name);
    const bool turned = shape->inwards != (call.to_world.determinant() < 0);
    for (const std::vector<Point>& facet : shape->facets) {
        SceneDescription::Face face;
        face.material = meaning->material, face.group = group->second;
        face.line = call.line_in_scene > 0 ? call.line_in_scene : p.line;
        for (const Point& corner : facet) {
            face.corners.push_back(static_cast<std::uint32_t>(d.points.size()));
            d.points.push_back(call.to_world.point(corner));
        }
        if (turned) std::reverse(face.corners.begin(), face.corners.end());
        if (emits) {
            const std::optional<std::uint32_t> material =
                emission_.material_of(*meaning, p, file, normal_of(face, d.points));
            if (!material) return;
            face.material = *material;
        }
        d.faces.push_back(face);
        // What reflects is seen from both sides; of a ball the other one is nowhere in view.
        if (meaning->kind != RadMeaning::Kind::reflects || shape->is_closed) continue;
        std::reverse(face.corners.begin(), face.corners.end());
        d.faces.push_back(std::move(face));
    }
}

/// A light infinitely far away: parallel, if it is small.
void RadianceReader::take_source(const RadPrimitive& p, const Call& call) {
    const RadPlace at{*call.file, p.line};
    const RadMeaning* meaning = materials_.meaning_of(p, at.file);
    if (!meaning) return;
    if (p.numbers.size() != 4)
        return findings_.error(at, fmt::format("source '{}' has {} numbers", p.name, p.numbers.size()));
    const Vec3 towards = call.to_world.vector({p.numbers[0], p.numbers[1], p.numbers[2]});
    const double length = norm(towards), angle = p.numbers[3] * pi / 180;
    constexpr double small = 0.2;  // radians: the sun has 0.0093
    if (!(length > 0) || !(angle > 0))
        return findings_.error(at, fmt::format("source '{}' has no direction or size", p.name));
    if (meaning->kind != RadMeaning::Kind::emits || angle > small)
        return findings_.note("skies and other wide sources", at);
    if (meaning->pattern_count > 0)
        return findings_.error(at,
                               fmt::format("the light of source '{}' has a pattern, which is not read", shown(p.name)));
    PunctualLight light;
    light.name = call.prefix + shown(p.name), light.kind = PunctualLight::Kind::directional;
    light.direction = -towards / length;
    light.intensity =
        (2 * pi * (1 - std::cos(0.5 * angle))) * radiance_of_exitance(materials_.materials[meaning->material].exitance);
    findings_.note("the size of a distant source, whose light is parallel", at);
    out_.description.lights.push_back(std::move(light));
}

void RadianceReader::take(RadPrimitive p, const Call& call) {
    if (is_rad_shape(p.type)) return take_surface(p, call);
    if (p.type == "source") return take_source(p, call);
    materials_.take(std::move(p), *call.file, call.to_world);
}

void RadianceReader::run_command(const std::string& command, int line, const Call& call) {
    const std::string& file = *call.file;
    TextLines lines(command);
    std::vector<std::string> words;
    if (lines.next())
        while (!lines.rest().empty()) words.emplace_back(lines.word());
    const std::string name = words.empty() ? "" : words[0];
    if (name != "xform" || command.find_first_of("|;<>`$&'\"") != command.npos)
        return findings_.error(
            {file, line}, fmt::format("the command '!{}' is not run", shown(command)),
            "run it yourself, write what it prints to a file, and name that in a line '!xform FILE'; of "
            "commands only xform is understood, without pipes and quotes");
    const Result<Xform> xform = parse_xform({words.begin() + 1, words.end()}, most_copies);
    if (!xform) return findings_.error({file, line}, xform.error().message, xform.error().hint);
    copies_ += xform->copies.size();
    if (call.depth >= deepest || copies_ > most_copies)
        return findings_.error({file, line}, call.depth >= deepest
                                                 ? fmt::format("files call each other {} deep", deepest)
                                                 : fmt::format("there are more than {} copies", most_copies));
    const std::string path = beside(path_, xform->file);
    auto text = texts_.find(path);
    if (text == texts_.end()) {
        Result<std::string> read = read_whole_file(path);
        if (!read)
            return findings_.error({file, line}, fmt::format("'{}' {}", shown(xform->file), read.error().message));
        bytes_ += read->size();
        text = texts_.emplace(path, std::move(*read)).first;
    }
    if (std::any_of(open_.begin(), open_.end(), [&](const std::string* open) { return *open == path; }))
        return findings_.error({file, line}, fmt::format("'{}' calls itself", shown(xform->file)));
    const std::string prefix = xform->name.empty() ? call.prefix : call.prefix + shown(xform->name) + ".";
    for (const Affine& copy : xform->copies) {
        if (findings_.failed()) return;  // once is enough to say what is wrong with a file
        read_file(
            path, text->second,
            {&path, call.to_world * copy, prefix, call.line_in_scene > 0 ? call.line_in_scene : line, call.depth + 1});
    }
}

void RadianceReader::read_file(const std::string& path, std::string_view text, const Call& call) {
    open_.push_back(&path);
    RadWords words(text);
    constexpr std::size_t most_errors = 100;
    while (findings_.error_count() <= most_errors) {
        const std::optional<std::string_view> word = words.next();
        if (!word && words.is_open_quote())
            findings_.error({path, words.line()}, "a quoted word does not end on its line");
        if (!word) break;
        if (word->starts_with('!') && !words.was_quoted()) {
            const int line = words.line();
            run_command(std::string(word->substr(1)) + words.rest_of_command(), line, call);
            continue;
        }
        RadPrimitive p;
        p.modifier = *word;
        if (const auto fault = read_primitive(words, p)) {
            findings_.error({path, fault->line}, fault->message);
            break;  // where the next one begins is anybody's guess
        }
        if (findings_.failed() && call.depth > 0) break;
        take(std::move(p), call);
    }
    open_.pop_back();
}

ReadScene RadianceReader::read() {
    const Result<std::string> text = read_whole_file(path_);
    if (text) {
        bytes_ = text->size();
        read_file(path_, *text, {&path_, {}, "", 0, 0});
    } else {
        findings_.error({path_, 0}, text.error().message);
    }
    out_.description.materials = std::move(materials_.materials);
    out_.description.profiles = std::move(emission_.profiles);
    out_.findings = findings_.take();
    return std::move(out_);
}

}  // namespace

ReadScene read_radiance(const std::string& path) {
    return RadianceReader(path).read();
}

}  // namespace exitance
