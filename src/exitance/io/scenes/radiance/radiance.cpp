#include "exitance/io/scenes/radiance/radiance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <list>
#include <set>
#include <unordered_map>

#include "exitance/base/polygon.hpp"
#include "exitance/io/files/scene_program.hpp"
#include "exitance/io/files/text_lines.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/scenes/radiance/rad_box_command.hpp"
#include "exitance/io/scenes/radiance/rad_command.hpp"
#include "exitance/io/scenes/radiance/rad_emission.hpp"
#include "exitance/io/scenes/radiance/rad_shapes.hpp"
#include "exitance/io/scenes/radiance/rad_sky.hpp"
#include "exitance/io/scenes/radiance/rad_sky_command.hpp"
#include "exitance/io/scenes/radiance/xform.hpp"

namespace exitance {
namespace {

constexpr std::size_t max_copies = 100'000, max_depth = 16;

/// A text being read, and the transform and options with which it was included.
struct Call {
    const std::string* name;  ///< Path of the file, or a description of the command that printed the text.
    Affine to_world;
    std::string prefix;
    std::string material;  ///< Material that replaces those of all surfaces; empty: they keep their own.
    int first_line = 0;    ///< Offset of the file's lines in SceneLines.
    int command_line = 0;  ///< SceneLines number of the command that printed the text; 0 for files.
    std::size_t depth = 0;
};

std::string folder_of(const std::string& path) {
    return std::filesystem::path(path).parent_path().string();
}

Normal normal_of(const SceneDescription::Face& face, const std::vector<Point>& points) {
    std::vector<Point> corners;
    for (const std::uint32_t c : face.corners) corners.push_back(points[c]);
    const Vec3 area = area_vector(corners);
    return norm(area) > 0 ? normalized(area) : Normal{0, 0, 1};
}

class RadianceReader {
  public:
    RadianceReader(std::span<const std::string> paths, const LoadOptions& options) : paths_(paths), options_(options) {}
    ReadScene read();

  private:
    void read_text(std::string_view text, const Call& call);
    void run_command(const std::string& command, int line, const Call& call);
    void read_copies(const std::vector<CommandWords>& stages, int line, const Call& call);
    /// A text, and the transforms with which it is repeated.
    struct Copied {
        const std::string* name = nullptr;
        const std::string* text = nullptr;
        int first_line = 0, command_line = 0;
        std::string prefix, material;
        std::vector<Affine> copies{1};
    };
    Result<Copied> copied_by(const std::vector<CommandWords>& stages, int line, const Call& call);
    Result<void> add_file(const std::string& name, Copied& out);
    Result<void> add_output(std::span<const CommandWords> stages, int line, const Call& call, Copied& out);
    Result<std::string> sky_text(const CommandWords& words, const RadPlace& at);
    int first_line(const std::string& path, std::string_view text);
    void take(RadPrimitive p, const Call& call);
    void take_surface(const RadPrimitive& p, const Call& call);
    void take_source(const RadPrimitive& p, const Call& call);
    void note_patterns(const RadMeaning& meaning);
    void open_up();

    std::span<const std::string> paths_;
    const LoadOptions& options_;
    std::string root_;  ///< Path of the root file being read: commands search files in its folder.
    ReadScene out_;
    RadFindings findings_;
    RadMaterials materials_{findings_};
    RadEmission emission_{materials_, findings_, root_};
    std::unordered_map<std::string, std::string> texts_;      ///< Files named in commands, each read once.
    std::list<std::pair<std::string, std::string>> outputs_;  ///< Description and output of commands.
    std::unordered_map<std::string, int> first_lines_;
    std::unordered_map<std::string, std::uint32_t> groups_;
    std::vector<const std::string*> open_;  ///< Names of the texts being read, to detect recursion.
    std::size_t copies_ = 0, bytes_ = 0;
    /// Spheres that emit inwards without a directional distribution, as ranges of faces.
    struct Bubble {
        std::size_t first = 0, last = 0;
        std::uint32_t material = 0;
    };
    std::vector<Bubble> bubbles_;
    bool opened_ = false;
    std::set<std::string> glass_names_;  ///< Modifiers of the panes so far.
};

/// Notes that patterns on reflecting materials are omitted.
void RadianceReader::note_patterns(const RadMeaning& meaning) {
    if (meaning.pattern_count == 0) return;
    const RadPattern& pattern = materials_.patterns[meaning.pattern];
    findings_.note("patterns and textures", {pattern.file, pattern.primitive.line});
}

void RadianceReader::take_surface(const RadPrimitive& p, const Call& call) {
    const std::string& file = *call.name;
    const RadMeaning* meaning = materials_.meaning_of(p, file);
    const std::optional<RadShape> shape = meaning ? rad_shape(p, file, findings_) : std::nullopt;
    if (!shape || meaning->kind == RadMeaning::Kind::left_out) return;
    const bool emits = meaning->kind == RadMeaning::Kind::emits;
    if (!emits) note_patterns(*meaning);
    auto& d = out_.description;
    // Limits the number of faces: one line can request any number of copies. Few scenes have more faces than this.
    if (const std::size_t max_faces = 300'000 + bytes_ / 20; d.faces.size() + 2 * shape->facets.size() > max_faces) {
        if (!findings_.failed())
            findings_.error({file, p.line}, fmt::format("copies make more than {} faces", max_faces),
                            "write the copies to a file with Radiance's own xform, and read that");
        return;
    }
    const std::string name = call.prefix + shown(p.name);
    const auto [group, is_new] = groups_.try_emplace(name, static_cast<std::uint32_t>(d.groups.size()));
    if (is_new) d.groups.push_back(name);
    if (emits && shape->is_closed && shape->inwards && meaning->pattern_count == 0)
        bubbles_.push_back({d.faces.size(), d.faces.size() + shape->facets.size(), meaning->material});
    const bool turned = shape->inwards != (call.to_world.determinant() < 0);
    for (const std::vector<Point>& facet : shape->facets) {
        SceneDescription::Face face;
        face.material = meaning->material, face.group = group->second;
        face.line = call.command_line > 0 ? call.command_line : call.first_line + p.line;
        for (const Point& corner : facet) {
            face.corners.push_back(static_cast<std::uint32_t>(d.points.size()));
            d.points.push_back(call.to_world.point(corner));
        }
        if (meaning->kind == RadMeaning::Kind::glass) {
            Pane pane = materials_.glass[meaning->material];
            if (glass_names_.insert(p.modifier).second)
                out_.glazed_by.push_back(fmt::format("glass '{}' ({}:{})", shown(p.modifier), file, p.line));
            for (const std::uint32_t c : face.corners) pane.corners.push_back(d.points[c]);
            pane.line = face.line;
            d.panes.push_back(std::move(pane));
            out_.pane_labels.push_back({p.modifier, name});
            continue;
        }
        if (turned) std::reverse(face.corners.begin(), face.corners.end());
        if (emits) {
            const std::optional<std::uint32_t> material =
                emission_.material_of(*meaning, p, file, normal_of(face, d.points));
            if (!material) return;
            face.material = *material;
        }
        d.faces.push_back(face);
        // Reflecting surfaces have two sides, but the inside of a closed body cannot be seen.
        if (meaning->kind != RadMeaning::Kind::reflects || shape->is_closed) continue;
        std::reverse(face.corners.begin(), face.corners.end());
        d.faces.push_back(std::move(face));
    }
}

/// Adds a distant light: the sun's disc, a sky, or the reflected light of the ground.
void RadianceReader::take_source(const RadPrimitive& p, const Call& call) {
    const RadPlace at{*call.name, p.line};
    const RadMeaning* meaning = materials_.meaning_of(p, at.file);
    if (!meaning) return;
    if (p.numbers.size() != 4)
        return findings_.error(at, fmt::format("source '{}' has {} numbers", p.name, p.numbers.size()));
    const Vec3 towards = call.to_world.vector({p.numbers[0], p.numbers[1], p.numbers[2]});
    const double length = norm(towards), angle = p.numbers[3] * pi / 180;
    if (!(length > 0) || !(angle > 0))
        return findings_.error(at, fmt::format("source '{}' has no direction or size", p.name));
    if (meaning->kind != RadMeaning::Kind::emits) return findings_.note("sources that do not emit", at);
    std::optional<SkyModel> pattern;
    if (meaning->pattern_count > 0) {
        const Result<SkyModel> sky = meaning->pattern_count == 1
                                         ? sky_of_pattern(materials_.patterns[meaning->pattern])
                                         : Error{ErrorCode::bad_input, "it modifies another pattern", "", ""};
        constexpr double max_disc_angle = 0.2;  // radians; larger than any sun
        if (!sky && angle > max_disc_angle)
            return findings_.note("skies with patterns that gensky and gendaylit do not print", at);
        if (!sky)
            return findings_.error(at,
                                   fmt::format("the light of source '{}' has a pattern, which is not read: {}",
                                               shown(p.name), sky.error().message),
                                   sky.error().hint);
        pattern = *sky;
    }
    const Spectrum radiance = radiance_of_exitance(materials_.materials[meaning->material].exitance);
    const std::optional<DistantLight> light =
        light_of_source(towards / length, angle, radiance, pattern ? &*pattern : nullptr);
    if (!light) return findings_.note("wide sources that are neither half of the sky nor the whole sky", at);
    out_.description.distant.append(*light);
}

void RadianceReader::take(RadPrimitive p, const Call& call) {
    if (const bool is_surface = is_rad_shape(p.type); is_surface || p.type == "source") {
        if (!call.material.empty()) p.modifier = call.material;
        return is_surface ? take_surface(p, call) : take_source(p, call);
    }
    materials_.take(std::move(p), *call.name, call.to_world);
}

int RadianceReader::first_line(const std::string& path, std::string_view text) {
    const auto [at, is_new] = first_lines_.try_emplace(path);
    if (is_new) at->second = out_.lines.add(path, 1 + static_cast<int>(std::count(text.begin(), text.end(), '\n')));
    return at->second;
}

Result<void> RadianceReader::add_file(const std::string& name, Copied& out) {
    const std::string path = beside(root_, name);
    auto text = texts_.find(path);
    if (text == texts_.end()) {
        Result<std::string> read = read_whole_file(path);
        if (!read)
            return Error{ErrorCode::bad_input, fmt::format("'{}' {}", shown(name), read.error().message), "", ""};
        bytes_ += read->size();
        text = texts_.emplace(path, std::move(*read)).first;
    }
    if (std::any_of(open_.begin(), open_.end(), [&](const std::string* open) { return *open == path; }))
        return Error{ErrorCode::bad_input, fmt::format("'{}' calls itself", shown(name)), "", ""};
    out.name = &text->first, out.text = &text->second, out.first_line = first_line(path, text->second);
    return {};
}

/// Returns the output of `!gensky` or `!gendaylit`; their warnings become findings.
Result<std::string> RadianceReader::sky_text(const CommandWords& words, const RadPlace& at) {
    Result<PrintedSky> printed = sky_command_output(words, options_.older_sky_programs);
    if (!printed) return printed.error();
    for (std::string& warning : printed->warnings) findings_.warning(at, std::move(warning));
    return std::move(printed->text);
}

/// Adds the output of a pipeline of programs.
Result<void> RadianceReader::add_output(std::span<const CommandWords> stages, int line, const Call& call, Copied& out) {
    const bool is_known = (is_sky_command(stages[0]) || is_box_command(stages[0])) && stages.size() == 1;
    if (!options_.run_commands && !is_known)
        return Error{ErrorCode::bad_input, fmt::format("the command '!{}' is not run", shown(stages[0][0])), "",
                     "--run-commands runs installed Radiance programs; or run it yourself, write its output to a file, "
                     "and name the file in a line '!xform FILE'"};
    const StopRequest never;
    std::string text;
    for (const CommandWords& words : stages) {
        Result<std::string> printed =
            is_known ? is_box_command(words) ? box_command_output(words) : sky_text(words, {*call.name, line})
                     : run_scene_program(words, text, folder_of(root_), options_.stop ? *options_.stop : never);
        // With --run-commands, the program itself handles options that are not supported here.
        if (is_known && !printed && options_.run_commands)
            printed = run_scene_program(words, text, folder_of(root_), options_.stop ? *options_.stop : never);
        if (!printed) return printed.error();
        text = std::move(*printed);
    }
    bytes_ += text.size();
    const auto& [name, kept] =
        outputs_.emplace_back(fmt::format("{}:{}: '!{}'", *call.name, line, stages[0][0]), std::move(text));
    out.name = &name, out.text = &kept;
    out.command_line = call.command_line > 0 ? call.command_line : call.first_line + line;
    return {};
}

/// Makes the copies of xform commands: a first xform with a file, and those at the end of a pipeline.
Result<RadianceReader::Copied> RadianceReader::copied_by(const std::vector<CommandWords>& stages, int line,
                                                         const Call& call) {
    Copied out;
    const auto multiply = [&](const Xform& xform) {
        std::vector<Affine> copies;
        for (const Affine& after : xform.copies)
            for (const Affine& before : out.copies) copies.push_back(after * before);
        out.copies = std::move(copies);
        if (!xform.name.empty()) out.prefix = shown(xform.name) + "." + out.prefix;
        if (!xform.material.empty()) out.material = xform.material;
    };
    std::size_t run = stages.size();
    std::vector<Xform> last;
    for (; run > 0 && stages[run - 1][0] == "xform"; --run) {
        Result<Xform> xform = parse_xform({stages[run - 1].begin() + 1, stages[run - 1].end()}, max_copies);
        if (!xform) return xform.error();
        if (xform->files.empty() != (run > 1))
            return Error{ErrorCode::bad_input,
                         run > 1 ? "xform has both a file and the output of a command to transform"
                                 : "xform has no file to transform",
                         "", ""};
        last.push_back(std::move(*xform));
    }
    const Result<void> added =
        run > 0 ? add_output(std::span(stages).first(run), line, call, out) : add_file(last.back().files[0], out);
    if (!added) return added.error();
    std::size_t copies = 1;
    for (const Xform& xform : last) copies = std::min(2 * max_copies, copies * xform.copies.size());
    copies_ += copies;
    if (copies_ > max_copies)
        return Error{ErrorCode::bad_input, fmt::format("there are more than {} copies", max_copies), "", ""};
    for (auto xform = last.rbegin(); xform != last.rend(); ++xform) multiply(*xform);
    return out;
}

void RadianceReader::run_command(const std::string& command, int line, const Call& call) {
    const RadPlace at{*call.name, line};
    if (call.depth >= max_depth)
        return findings_.error(at, fmt::format("files include each other {} levels deep", max_depth));
    const Result<std::vector<CommandWords>> stages = parse_command(command);
    if (!stages) return findings_.error(at, stages.error().message, stages.error().hint);
    const CommandWords& first = stages->front();
    const Result<Xform> xform =
        first[0] == "xform" ? parse_xform({first.begin() + 1, first.end()}, max_copies) : Result<Xform>(Xform());
    if (!xform || xform->files.size() < 2) return read_copies(*stages, line, call);
    for (const std::string& file : xform->files) {
        std::vector<CommandWords> of_one = *stages;
        of_one.front() = {"xform"};
        of_one.front().insert(of_one.front().end(), xform->options.begin(), xform->options.end());
        of_one.front().push_back(file);
        read_copies(of_one, line, call);
    }
}

void RadianceReader::read_copies(const std::vector<CommandWords>& stages, int line, const Call& call) {
    const Result<Copied> copied = copied_by(stages, line, call);
    if (!copied) return findings_.error({*call.name, line}, copied.error().message, copied.error().hint);
    for (const Affine& copy : copied->copies) {
        if (findings_.failed()) return;  // the first copy has reported the file's errors
        read_text(*copied->text, {copied->name, call.to_world * copy, call.prefix + copied->prefix,
                                  call.material.empty() ? copied->material : call.material, copied->first_line,
                                  copied->command_line, call.depth + 1});
    }
}

void RadianceReader::read_text(std::string_view text, const Call& call) {
    open_.push_back(call.name);
    RadWords words(text);
    constexpr std::size_t most_errors = 100;
    while (findings_.error_count() <= most_errors) {
        const std::optional<std::string_view> word = words.next();
        if (!word && words.is_open_quote())
            findings_.error({*call.name, words.line()}, "a quoted word does not end on its line");
        if (!word) break;
        if (word->starts_with('!') && !words.was_quoted()) {
            const int line = words.line();
            run_command(std::string(word->substr(1)) + words.rest_of_command(), line, call);
            continue;
        }
        RadPrimitive p;
        p.modifier = *word;
        if (const auto fault = read_primitive(words, p)) {
            findings_.error({*call.name, fault->line}, fault->message);
            break;  // the beginning of the next primitive is unknown
        }
        if (findings_.failed() && call.depth > 0) break;
        take(std::move(p), call);
    }
    open_.pop_back();
}

/// Replaces a sphere that emits evenly inwards and contains the whole scene by a uniform sky above and below, which
/// gives every point the same light at any radius. Light that reaches the sphere is lost to the sky.
void RadianceReader::open_up() {
    SceneDescription& d = out_.description;
    if (bubbles_.size() != 1) return;
    const Bubble& bubble = bubbles_.front();
    Box box, rest;
    for (std::size_t i = 0; i < d.faces.size(); ++i)
        for (const std::uint32_t c : d.faces[i].corners)
            (i >= bubble.first && i < bubble.last ? box : rest).add(d.points[c]);
    const Vec3 half = 0.5 * box.size();
    // Shares of the radius: a limit for the deviation of facets from the sphere, and for the scene inside it.
    constexpr double ball = 1e-2, well_within = 0.9;
    const double radius = half.x;
    const bool is_ball = std::abs(half.y - radius) < ball * radius && std::abs(half.z - radius) < ball * radius;
    if (!is_ball || rest.is_empty()) return;
    for (std::size_t i = 0; i < d.faces.size(); ++i) {
        if (i >= bubble.first && i < bubble.last) continue;
        for (const std::uint32_t c : d.faces[i].corners)
            if (norm(d.points[c] - box.centre()) > well_within * radius) return;
    }
    const Spectrum radiance = radiance_of_exitance(materials_.materials[bubble.material].exitance);
    if (const auto light = light_of_source({0, 0, 1}, 2 * pi, radiance, nullptr)) d.distant.append(*light);
    d.faces.erase(d.faces.begin() + static_cast<std::ptrdiff_t>(bubble.first),
                  d.faces.begin() + static_cast<std::ptrdiff_t>(bubble.last));
    opened_ = true;
}

ReadScene RadianceReader::read() {
    out_.description.file = paths_.front();
    for (const std::string& path : paths_) {
        root_ = path;
        const Result<std::string> text = read_whole_file(path);
        if (!text) {
            findings_.error({path, 0}, text.error().message);
            break;
        }
        bytes_ += text->size();
        read_text(*text, {&path, {}, "", "", first_line(path, *text), 0, 0});
        if (findings_.failed()) break;  // stop: later files may use names that the failed file should have defined
    }
    if (!findings_.failed()) open_up();
    out_.description.materials = std::move(materials_.materials);
    out_.description.profiles = std::move(emission_.profiles);
    out_.findings = findings_.take();
    if (opened_)
        out_.findings.push_back(
            {Finding::Kind::warning, paths_.front(), 0,
             "an emitting sphere around everything else is read as a uniform sky, infinitely far away", ""});
    return std::move(out_);
}

}  // namespace

ReadScene read_radiance(std::span<const std::string> paths, const LoadOptions& options) {
    return RadianceReader(paths, options).read();
}

ReadScene read_radiance(const std::string& path) {
    return read_radiance(std::span(&path, 1), {});
}

}  // namespace exitance
