#include "exitance/io/scenes/radiance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>

#include "exitance/io/files/text_lines.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/scenes/round_shapes.hpp"
#include "exitance/io/scenes/xform.hpp"

namespace exitance {
namespace {

constexpr std::size_t most_copies = 100'000, deepest = 16;

/// Words of a file; '#' at the start of one begins a comment; a line that begins with '!' is a command by itself.
class RadWords {
  public:
    explicit RadWords(std::string_view text) : rest_(text) {}

    /// Empty at the end.
    std::string_view next();
    /// After a word that begins with '!': the rest of the command, a backslash at the end of a line going on.
    std::string rest_of_command();
    int line() const { return line_; }  ///< Of the last word.

  private:
    void pass() {
        if (rest_.front() == '\n') ++at_;
        rest_.remove_prefix(1);
    }
    static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f' || c == '\v'; }

    std::string_view rest_;
    int at_ = 1, line_ = 1;
};

std::string_view RadWords::next() {
    while (!rest_.empty()) {
        if (rest_.front() == '#')
            while (!rest_.empty() && rest_.front() != '\n') pass();
        else if (is_blank(rest_.front()))
            pass();
        else
            break;
    }
    line_ = at_;
    std::size_t n = 0;
    while (n < rest_.size() && !is_blank(rest_[n])) ++n;
    const std::string_view word = rest_.substr(0, n);
    rest_.remove_prefix(n);
    return word;
}

std::string RadWords::rest_of_command() {
    std::string out;
    while (!rest_.empty() && rest_.front() != '\n') {
        const bool goes_on = rest_.starts_with("\\\n") || rest_.starts_with("\\\r\n");
        if (goes_on)
            while (rest_.front() != '\n') pass();
        else
            out += rest_.front();
        pass();
    }
    return out;
}

/// A primitive: modifier, type, name and its arguments.
struct Primitive {
    std::string modifier, type, name;
    std::vector<std::string> words;
    std::vector<double> numbers;
    int line = 0;
};

/// What a name of a material stands for.
struct Meaning {
    enum class Kind { reflects, emits, left_out } kind = Kind::left_out;
    std::uint32_t material = 0;
};

/// Where a file stands among those that call it.
struct Place {
    const std::string* file;
    Affine to_world;
    std::string prefix;
    int line_in_scene = 0;  ///< Of the command in the scene's own file; 0 in that file.
    std::size_t depth = 0;
};

class RadianceReader {
  public:
    explicit RadianceReader(const std::string& path) : path_(path) { out_.description.file = path; }
    ReadScene read();

  private:
    void read_file(const std::string& path, std::string_view text, const Place& place);
    void run_command(const std::string& command, int line, const Place& place);
    bool read_primitive(RadWords& words, Primitive& out, const std::string& file);
    void take(const Primitive& p, const Place& place, const std::string& file);
    bool take_material(const Primitive& p, const std::string& file);
    void add_material(const Primitive& p, Meaning::Kind kind, const Spectrum& reflectance, const Spectrum& radiance);
    void take_surface(const Primitive& p, const Place& place, const std::string& file);
    void take_source(const Primitive& p, const Place& place, const std::string& file);
    bool facets_of(const Primitive& p, const std::string& file, Facets& facets, bool& inwards, bool& is_closed);
    const Meaning* meaning_of(const Primitive& p, const std::string& file);
    void note(const std::string& what, const std::string& file, int line) {
        const auto [at, is_new] = notes_.try_emplace(what, Note{file, line, 0});
        ++at->second.count;
    }
    void error(const std::string& file, int line, std::string message, std::string hint = "") {
        failed_ = true;
        out_.findings.push_back({Finding::Kind::error, file, line, std::move(message), std::move(hint)});
    }

    const std::string& path_;
    ReadScene out_;
    struct Note {
        std::string file;
        int line;
        std::size_t count;
    };
    std::map<std::string, Note> notes_;  ///< What is left out, each kind once.
    std::unordered_map<std::string, Meaning> meanings_;
    std::unordered_map<std::string, std::string> texts_;  ///< Files that commands name, read once.
    std::unordered_map<std::string, std::uint32_t> groups_;
    std::vector<const std::string*> open_;  ///< Files being read, which may not call themselves.
    std::size_t copies_ = 0, bytes_ = 0;
    bool failed_ = false;
};

bool RadianceReader::read_primitive(RadWords& words, Primitive& out, const std::string& file) {
    out.type = words.next(), out.name = words.next();
    out.line = words.line();
    if (out.name.empty()) return error(file, out.line, "the file ends within a primitive"), false;
    if (out.type == "alias") {
        out.words = {std::string(words.next())};
        return !out.words[0].empty() || (error(file, out.line, "the file ends within an alias"), false);
    }
    for (int list = 0; list < 3; ++list) {  // words, whole numbers, numbers
        const std::string_view word = words.next();
        const std::optional<long long> count = parse_integer(word);
        if (!count || *count < 0)
            return error(file, words.line(),
                         fmt::format("'{}' is no count of the arguments of '{}'", shown(word), shown(out.name))),
                   false;
        for (long long i = 0; i < *count; ++i) {
            const std::string_view argument = words.next();
            double value = 0;
            if (argument.empty())
                return error(file, out.line, fmt::format("the file ends within '{}'", shown(out.name))), false;
            if (list == 0) {
                out.words.emplace_back(argument);
            } else if (number_of_word(argument, value) != NumberKind::finite) {
                return error(file, words.line(), fmt::format("'{}' is not a finite number", shown(argument))), false;
            } else if (list == 2) {
                out.numbers.push_back(value);
            }
        }
    }
    return true;
}

Spectrum spread(const std::vector<double>& rgb, double factor) {
    Spectrum out;
    if (bands == 1) return Spectrum(factor * (rgb[0] + rgb[1] + rgb[2]) / 3);
    for (std::size_t b = 0; b < bands; ++b) out[b] = factor * rgb[b * 3 / bands];
    return out;
}

void RadianceReader::add_material(const Primitive& p, Meaning::Kind kind, const Spectrum& reflectance,
                                  const Spectrum& radiance) {
    meanings_[p.name] = {kind, static_cast<std::uint32_t>(out_.description.materials.size())};
    out_.description.materials.push_back({shown(p.name), reflectance, exitance_of_radiance(radiance)});
}

/// Materials by their diffuse parts; false if the primitive is none.
bool RadianceReader::take_material(const Primitive& p, const std::string& file) {
    const auto is = [&](std::initializer_list<const char*> names) {
        return std::any_of(names.begin(), names.end(), [&](const char* name) { return p.type == name; });
    };
    const bool reflects = is({"plastic", "metal", "plastic2", "metal2", "trans", "trans2"});
    const bool emits = is({"light", "glow", "illum", "spotlight"});
    const bool clear = is({"glass", "dielectric", "interface", "mirror", "mist", "antimatter", "prism1", "prism2"});
    if (!reflects && !emits && !clear) return false;
    const std::size_t wanted = reflects ? (p.type.starts_with("trans") ? 7 : 5) : p.type == "glow" ? 4 : 3;
    if (!clear && p.numbers.size() < (p.type.ends_with('2') ? wanted - 1 : wanted)) {
        error(file, p.line,
              fmt::format("'{}' has {} numbers, {} has {}", shown(p.name), p.numbers.size(), p.type, wanted));
        return true;
    }
    if (reflects) {
        const double specular = p.numbers[3];
        const bool trans = p.type.starts_with("trans");
        // Two roughnesses stand elsewhere; what goes through comes after them.
        const double through = trans ? p.numbers[p.numbers.size() - 2] : 0;
        if (specular > 0) note("a specular part", file, p.line);
        if (through > 0) note("light that goes through", file, p.line);
        const Spectrum reflectance = spread(p.numbers, (1 - specular) * (1 - through));
        if (!(max(reflectance) < 1) ||
            !std::all_of(reflectance.value.begin(), reflectance.value.end(), [](double v) { return v >= 0; }))
            error(file, p.line, fmt::format("material '{}' reflects {:g}", shown(p.name), max(reflectance)),
                  "diffuse reflectances lie in [0, 1)");
        add_material(p, Meaning::Kind::reflects, reflectance, {});
    } else if (emits) {
        if (p.type == "spotlight") note("the cone of a spotlight, which shines everywhere", file, p.line);
        if (p.type == "glow" && p.numbers[3] != 0) note("the radius of a glow", file, p.line);
        if (std::any_of(p.numbers.begin(), p.numbers.begin() + 3, [](double v) { return v < 0; }))
            error(file, p.line, fmt::format("'{}' emits less than nothing", shown(p.name)));
        add_material(p, Meaning::Kind::emits, {}, spread(p.numbers, 1));
    } else if (p.type == "mirror") {
        note("a mirror, which is black", file, p.line);
        add_material(p, Meaning::Kind::reflects, {}, {});
    } else {
        note(fmt::format("surfaces of {}, which light passes", p.type), file, p.line);
        meanings_[p.name] = {Meaning::Kind::left_out, 0};
    }
    if (p.modifier != "void") note("patterns and textures", file, p.line);
    return true;
}

const Meaning* RadianceReader::meaning_of(const Primitive& p, const std::string& file) {
    const auto found = meanings_.find(p.modifier);
    if (found != meanings_.end()) return &found->second;
    if (p.modifier == "void")
        error(file, p.line, fmt::format("'{}' has no material", shown(p.name)),
              "void reflects nothing: name a material");
    else
        error(file, p.line, fmt::format("material '{}' is not defined before '{}'", shown(p.modifier), shown(p.name)));
    return nullptr;
}

/// The polygons of a surface; `inwards`: their fronts are the inside.
bool RadianceReader::facets_of(const Primitive& p, const std::string& file, Facets& facets, bool& inwards,
                               bool& is_closed) {
    const std::vector<double>& v = p.numbers;
    const auto point = [&](std::size_t i) { return Point{v[i], v[i + 1], v[i + 2]}; };
    const auto wrong = [&](const std::string& why) {
        return error(file, p.line, fmt::format("{} '{}' {}", p.type, shown(p.name), why)), false;
    };
    const auto takes = [&](std::size_t count) {
        return v.size() == count || wrong(fmt::format("has {} numbers, not {}", v.size(), count));
    };
    if (p.type == "polygon") {
        if (v.size() < 9 || v.size() % 3 != 0) return wrong(fmt::format("has {} numbers", v.size()));
        facets.emplace_back();
        for (std::size_t i = 0; i < v.size(); i += 3) facets[0].push_back(point(i));
        return true;
    }
    if (p.type == "sphere" || p.type == "bubble") {
        if (!takes(4)) return false;
        if (v[3] == 0) return wrong("has radius 0");
        inwards = (p.type == "bubble") != (v[3] < 0), is_closed = true;
        facets = sphere_facets(point(0), std::abs(v[3]));
        return true;
    }
    if (p.type == "ring") {
        if (!takes(8)) return false;
        const double length = norm(point(3)), inner = std::min(v[6], v[7]), outer = std::max(v[6], v[7]);
        if (!(length > 0) || inner < 0 || !(outer > inner)) return wrong("has no direction or no width");
        facets = ring_facets(point(0), point(3) / length, inner, outer);
        return true;
    }
    const bool cone = p.type == "cone" || p.type == "cup";
    if (!takes(cone ? 8 : 7)) return false;
    const double from = v[6], to = cone ? v[7] : v[6];
    if (point(0) == point(3) || from < 0 || to < 0 || from + to == 0) return wrong("has no length or no radius");
    inwards = p.type == "cup" || p.type == "tube";
    facets = cone_facets(point(0), point(3), from, to);
    return true;
}

void RadianceReader::take_surface(const Primitive& p, const Place& place, const std::string& file) {
    Facets facets;
    bool inwards = false, is_closed = false;
    const Meaning* meaning = meaning_of(p, file);
    if (!meaning || !facets_of(p, file, facets, inwards, is_closed) || meaning->kind == Meaning::Kind::left_out) return;
    auto& d = out_.description;
    // A line of text can ask for any number of copies. Most scenes have no more than these.
    if (const std::size_t most = 300'000 + bytes_ / 20; d.faces.size() + 2 * facets.size() > most) {
        if (!failed_)
            error(file, p.line, fmt::format("copies make more than {} faces", most),
                  "write the copies to a file with Radiance's own xform, and read that");
        return;
    }
    const std::string name = place.prefix + shown(p.name);
    const auto [group, is_new] = groups_.try_emplace(name, static_cast<std::uint32_t>(d.groups.size()));
    if (is_new) d.groups.push_back(name);
    const bool turned = inwards != (place.to_world.determinant() < 0);
    for (const std::vector<Point>& facet : facets) {
        SceneDescription::Face face;
        face.material = meaning->material, face.group = group->second;
        face.line = place.line_in_scene > 0 ? place.line_in_scene : p.line;
        for (const Point& corner : facet) {
            face.corners.push_back(static_cast<std::uint32_t>(d.points.size()));
            d.points.push_back(place.to_world.point(corner));
        }
        if (turned) std::reverse(face.corners.begin(), face.corners.end());
        d.faces.push_back(face);
        // What reflects is seen from both sides; of a ball the other one is nowhere in view.
        if (meaning->kind != Meaning::Kind::reflects || is_closed) continue;
        std::reverse(face.corners.begin(), face.corners.end());
        d.faces.push_back(std::move(face));
    }
}

/// A light infinitely far away: parallel, if it is small.
void RadianceReader::take_source(const Primitive& p, const Place& place, const std::string& file) {
    const Meaning* meaning = meaning_of(p, file);
    if (!meaning) return;
    if (p.numbers.size() != 4)
        return error(file, p.line, fmt::format("source '{}' has {} numbers", p.name, p.numbers.size()));
    const Vec3 towards = place.to_world.vector({p.numbers[0], p.numbers[1], p.numbers[2]});
    const double length = norm(towards), angle = p.numbers[3] * pi / 180;
    constexpr double small = 0.2;  // radians: the sun has 0.0093
    if (!(length > 0) || !(angle > 0))
        return error(file, p.line, fmt::format("source '{}' has no direction or size", p.name));
    if (meaning->kind != Meaning::Kind::emits || angle > small)
        return note("skies and other wide sources", file, p.line);
    PunctualLight light;
    light.name = place.prefix + shown(p.name), light.kind = PunctualLight::Kind::directional;
    light.direction = -towards / length;
    light.intensity = (2 * pi * (1 - std::cos(0.5 * angle))) *
                      radiance_of_exitance(out_.description.materials[meaning->material].exitance);
    note("the size of a distant source, whose light is parallel", file, p.line);
    out_.description.lights.push_back(std::move(light));
}

void RadianceReader::take(const Primitive& p, const Place& place, const std::string& file) {
    static constexpr std::array surfaces = {"polygon", "sphere", "bubble", "ring", "cone", "cup", "cylinder", "tube"};
    if (std::find(surfaces.begin(), surfaces.end(), p.type) != surfaces.end()) return take_surface(p, place, file);
    if (p.type == "source") return take_source(p, place, file);
    if (p.type == "alias") {
        const auto meaning = meanings_.find(p.words[0]);
        if (meaning == meanings_.end())
            return error(
                file, p.line,
                fmt::format("alias '{}' stands for '{}', which is not defined", shown(p.name), shown(p.words[0])));
        const Meaning same = meaning->second;
        meanings_[p.name] = same;
        return;
    }
    if (take_material(p, file)) return;
    if (p.type == "mesh" || p.type == "instance")
        return error(file, p.line,
                     fmt::format("{} '{}' stands in a compiled file, which is not read", p.type, shown(p.name)),
                     "put its polygons here, with !xform");
    // Patterns, textures and mixtures: a surface may go through them to a material.
    const auto below = meanings_.find(p.modifier);
    if (below != meanings_.end()) {
        const Meaning same = below->second;
        meanings_[p.name] = same;
    }
    note("patterns and textures", file, p.line);
    if (below == meanings_.end() && p.modifier != "void")
        error(file, p.line, fmt::format("material '{}' is not defined before '{}'", shown(p.modifier), shown(p.name)));
}

void RadianceReader::run_command(const std::string& command, int line, const Place& place) {
    const std::string& file = *place.file;
    TextLines lines(command);
    std::vector<std::string> words;
    if (lines.next())
        while (!lines.rest().empty()) words.emplace_back(lines.word());
    const std::string name = words.empty() ? "" : words[0];
    if (name != "xform" || command.find_first_of("|;<>`$&'\"") != command.npos)
        return error(file, line, fmt::format("the command '!{}' is not run", shown(command)),
                     "run it yourself, write what it prints to a file, and name that in a line '!xform FILE'; of "
                     "commands only xform is understood, without pipes and quotes");
    const Result<Xform> xform = parse_xform({words.begin() + 1, words.end()}, most_copies);
    if (!xform) return error(file, line, xform.error().message, xform.error().hint);
    copies_ += xform->copies.size();
    if (place.depth >= deepest || copies_ > most_copies)
        return error(file, line,
                     place.depth >= deepest ? fmt::format("files call each other {} deep", deepest)
                                            : fmt::format("there are more than {} copies", most_copies));
    const std::string path = beside(path_, xform->file);
    auto text = texts_.find(path);
    if (text == texts_.end()) {
        Result<std::string> read = read_whole_file(path);
        if (!read) return error(file, line, fmt::format("'{}' {}", shown(xform->file), read.error().message));
        bytes_ += read->size();
        text = texts_.emplace(path, std::move(*read)).first;
    }
    if (std::any_of(open_.begin(), open_.end(), [&](const std::string* open) { return *open == path; }))
        return error(file, line, fmt::format("'{}' calls itself", shown(xform->file)));
    const std::string prefix = xform->name.empty() ? place.prefix : place.prefix + shown(xform->name) + ".";
    for (const Affine& copy : xform->copies) {
        if (failed_) return;  // once is enough to say what is wrong with a file
        read_file(path, text->second,
                  {&path, place.to_world * copy, prefix, place.line_in_scene > 0 ? place.line_in_scene : line,
                   place.depth + 1});
    }
}

void RadianceReader::read_file(const std::string& path, std::string_view text, const Place& place) {
    open_.push_back(&path);
    RadWords words(text);
    constexpr std::size_t most_errors = 100;
    for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
        if (out_.findings.size() > most_errors) break;
        if (word.front() == '!') {
            const int line = words.line();
            run_command(std::string(word.substr(1)) + words.rest_of_command(), line, place);
            continue;
        }
        Primitive p;
        p.modifier = word;
        if (!read_primitive(words, p, path)) break;  // where the next one begins is anybody's guess
        if (failed_ && place.depth > 0) break;
        take(p, place, path);
    }
    open_.pop_back();
}

ReadScene RadianceReader::read() {
    const Result<std::string> text = read_whole_file(path_);
    if (!text) {
        error(path_, 0, text.error().message);
        return std::move(out_);
    }
    bytes_ = text->size();
    read_file(path_, *text, {&path_, {}, "", 0, 0});
    for (const auto& [what, note] : notes_)
        out_.findings.push_back(
            {Finding::Kind::warning, note.file, note.line,
             fmt::format("left out: {}{}", what,
                         note.count == 1 ? "" : fmt::format(" ({} times, the first of them here)", note.count)),
             ""});
    return std::move(out_);
}

}  // namespace

ReadScene read_radiance(const std::string& path) {
    return RadianceReader(path).read();
}

}  // namespace exitance
