#include "exitance/io/scenes/obj/mtl.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "exitance/io/files/text_lines.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/scenes/textures/masked_picture.hpp"

namespace exitance {
namespace {

std::string band_name(std::size_t band, std::size_t count) {
    static constexpr const char* rgb[3] = {"red", "green", "blue"};
    if (count == 1) return "all bands";
    return count == 3 ? rgb[band] : fmt::format("band {}", band);
}

/// Converts a file's values to the bands of this build: unchanged, one for all, or three mapped to more or fewer bands.
Spectrum spectrum_of_values(const std::vector<double>& values) {
    Spectrum out;
    if (values.size() == 3 && bands == 1) return Spectrum((values[0] + values[1] + values[2]) / 3);
    for (std::size_t b = 0; b < bands; ++b) out[b] = values[values.size() == bands ? b : b * values.size() / bands];
    return out;
}

class MtlReader {
  public:
    MtlReader(std::string_view text, const std::string& file, std::vector<Material>& materials,
              std::vector<Finding>& findings, MtlExtras& extras)
        : lines_(text), file_(file), materials_(materials), findings_(findings), extras_(extras) {}
    void read();

  private:
    void start_material();
    void read_values(const std::string& key, Spectrum Material::*value);
    bool read_number(const std::string& key, std::string_view word, std::vector<double>& out);
    void read_filter(std::string_view key);
    void read_texture(std::string& name);
    void end_material();
    void take_textures();
    std::shared_ptr<const TextureArea> picture(const std::string& name, const std::string& otherwise,
                                               bool is_coverage = false);
    void take_glass();
    void warn_all();
    void find(Finding::Kind kind, int line, std::string message, std::string hint) {
        findings_.push_back({kind, file_, line, std::move(message), std::move(hint)});
    }
    void error(std::string message, std::string hint = "") {
        find(Finding::Kind::error, lines_.number(), std::move(message), std::move(hint));
    }

    TextLines lines_;
    const std::string& file_;
    std::vector<Material>& materials_;
    std::vector<Finding>& findings_;
    Material material_;
    bool open_ = false, has_reflectance_ = false;
    int line_ = 0, reflectance_line_ = 0;
    std::size_t white_materials_ = 0;
    int white_line_ = 0;  ///< Line of the first of the `white_materials_`.
    std::string white_name_;
    MtlExtras& extras_;
    double opacity_ = 1;              ///< d
    std::optional<Spectrum> filter_;  ///< Tf
    long long illum_ = 0;
    std::string texture_, glow_, holes_;  ///< File names of map_Kd, map_Ke and map_d.
    struct Told {
        std::size_t count = 0;
        int line = 0;
        std::string name;
        void add(int at, const std::string& material) {
            if (count++ == 0) line = at, name = material;
        }
        std::string names() const {
            return fmt::format("material '{}'{}", shown(name),
                               count > 1 ? fmt::format(" (and {} more)", count - 1) : "");
        }
    } glazed_, opaque_, textured_;
};

void MtlReader::read() {
    while (lines_.next()) {
        const std::string_view key = lines_.word();
        if (key == "newmtl")
            start_material();
        else if (key == "Kd" || key == "Ke")
            read_values(std::string(key), key == "Kd" ? &Material::reflectance : &Material::exitance);
        else if (key == "d" || key == "Tf" || key == "illum")
            read_filter(key);
        else if (key == "map_Kd" || key == "map_Ke" || key == "map_d")
            read_texture(key == "map_Kd" ? texture_ : key == "map_Ke" ? glow_ : holes_);
    }
    end_material();
    warn_all();
    if (white_materials_ > 0)
        find(Finding::Kind::repair, white_line_,
             fmt::format("material '{}'{} has a reflectance Kd of 1: {} is used instead", shown(white_name_),
                         white_materials_ > 1 ? fmt::format(" (and {} more)", white_materials_ - 1) : "",
                         mended_reflectance),
             "nothing reflects all light; with 1 reflections would never fade");
}

void MtlReader::start_material() {
    end_material();
    material_ = {};
    material_.name = std::string(lines_.rest());
    if (material_.name.empty()) error("'newmtl' without a name");
    open_ = true, has_reflectance_ = false, reflectance_line_ = lines_.number();
    opacity_ = 1, filter_.reset(), illum_ = 0, texture_.clear(), glow_.clear(), holes_.clear();
    line_ = lines_.number();
}

/// Reads how much light passes. Unreadable values are ignored: many files have nonsense here.
void MtlReader::read_filter(std::string_view key) {
    if (!open_) return;
    std::vector<double> values;
    while (!lines_.rest().empty() && values.size() < 3) {
        double v = 0;
        const std::string_view word = lines_.word();
        if (word == "-halo") continue;
        if (number_of_word(word, v) != NumberKind::finite) return;
        values.push_back(std::clamp(v, 0.0, key == "illum" ? 99.0 : 1.0));
    }
    if (values.empty()) return;
    if (key == "d")
        opacity_ = values[0];
    else if (key == "illum")
        illum_ = std::llround(values[0]);
    else
        filter_ = spectrum_of_values(values.size() == 3 ? values : std::vector<double>(3, values[0]));
}

/// Reads the name after options of one or more words each. Without options, the name may contain blanks.
void MtlReader::read_texture(std::string& name) {
    if (!open_) return;
    if (!lines_.rest().starts_with('-')) {
        name = std::string(lines_.rest());
        return;
    }
    while (!lines_.rest().empty()) name = std::string(lines_.word());
}

std::shared_ptr<const TextureArea> MtlReader::picture(const std::string& name, const std::string& otherwise,
                                                      bool is_coverage) {
    const std::string file = found_beside(file_, name);
    std::shared_ptr<const TextureArea>& out = is_coverage ? extras_.read_coverage[file] : extras_.read[file];
    if (out) return out;
    const Result<std::string> bytes = read_whole_file(file);
    Result<TextureArea> area = Error{};
    if (bytes) {
        const std::span data(reinterpret_cast<const std::uint8_t*>(bytes->data()), bytes->size());
        area = is_coverage ? decode_coverage(data, 0.5) : TextureArea::of(data, srgb_curve());
    } else {
        area = bytes.error();
    }
    if (area) return out = std::make_shared<const TextureArea>(std::move(*area));
    find(Finding::Kind::warning, line_,
         fmt::format("the texture '{}' of material '{}' {}: {}", shown(name), shown(material_.name),
                     area.error().message, otherwise),
         "put it in the folder of the material file, as PNG or JPEG");
    return nullptr;
}

void MtlReader::take_textures() {
    MtlPictures pictures;
    const auto mean_of = [](const TextureArea& picture) {
        const TextureArea::Colour c = picture.mean();
        return spectrum_of_values({c[0], c[1], c[2]});
    };
    if (!texture_.empty()) pictures.reflectance = picture(texture_, "Kd is used alone");
    if (pictures.reflectance) {
        if (!has_reflectance_) material_.reflectance = Spectrum(1.0), has_reflectance_ = true;
        material_.reflectance *= mean_of(*pictures.reflectance);
    }
    if (!glow_.empty() && material_.emits()) pictures.exitance = picture(glow_, "Ke is used alone");
    if (pictures.exitance) material_.exitance *= mean_of(*pictures.exitance);
    if (!holes_.empty()) pictures.coverage = picture(holes_, "its faces are opaque", true);
    if (!pictures.reflectance && !pictures.exitance && !pictures.coverage) return;
    if (pictures.reflectance || pictures.exitance) textured_.add(line_, material_.name);
    extras_.pictures.emplace(material_.name, std::move(pictures));
}

void MtlReader::take_glass() {
    const bool is_glass = opacity_ < 1 || (filter_ && (illum_ == 4 || illum_ == 6 || illum_ == 7 || illum_ == 9));
    if (!is_glass || material_.emits()) return;
    const Spectrum passes = (opacity_ < 1 ? 1 - opacity_ : 1) * filter_.value_or(Spectrum(1.0));
    // Materials that transmit less, such as leaves and curtains, are not glass.
    constexpr double min_transmission = 0.5;
    if (!(mean(passes) > min_transmission)) return opaque_.add(line_, material_.name);
    extras_.glass.emplace(material_.name,
                          MtlExtras::Glass{transmissivity_of(passes), fmt::format("{}:{}", file_, line_)});
    glazed_.add(line_, material_.name);
}

void MtlReader::warn_all() {
    if (textured_.count > 0)
        find(Finding::Kind::warning, textured_.line,
             fmt::format("{} has a texture: a face, or a part of a face where it varies, gets the mean of its part of "
                         "the texture",
                         textured_.names()),
             "");
    if (opaque_.count > 0)
        find(Finding::Kind::warning, opaque_.line,
             fmt::format("{} lets light through, but no more than half of it: here it is opaque", opaque_.names()), "");
    if (glazed_.count > 0)
        find(Finding::Kind::warning, glazed_.line,
             fmt::format("{} lets light through: its faces are panes of clear glass, which do not reflect diffusely",
                         glazed_.names()),
             "'d 1' makes a face opaque");
}

void MtlReader::end_material() {
    if (!open_) return;
    const auto same = [&](const Material& m) { return m.name == material_.name; };
    if (std::any_of(materials_.begin(), materials_.end(), same)) {
        find(Finding::Kind::warning, line_,
             fmt::format("material '{}' is already defined: the first definition is used", shown(material_.name)),
             "give it another name");
        return;
    }
    take_textures();
    if (mend_reflectance(material_.reflectance) && white_materials_++ == 0)
        white_line_ = reflectance_line_, white_name_ = material_.name;
    take_glass();
    if (!has_reflectance_)
        find(Finding::Kind::warning, line_,
             fmt::format("material '{}' has no Kd: it reflects nothing", shown(material_.name)),
             "add a line 'Kd r g b'");
    materials_.push_back(std::move(material_));
}

/// Reads Kd or Ke of the current material. Ke is a radiance and is stored as exitance.
void MtlReader::read_values(const std::string& key, Spectrum Material::*value) {
    if (!open_) return error(fmt::format("'{}' comes before any 'newmtl'", key));
    const bool reflectance = key == "Kd";
    has_reflectance_ = has_reflectance_ || reflectance;
    if (lines_.rest().starts_with("spectral") || lines_.rest().starts_with("xyz"))
        return error(
            fmt::format("'{} {}' of material '{}' is not supported", key, lines_.word(), shown(material_.name)),
            "give the values as 'r g b'");
    std::vector<double> values;
    while (!lines_.rest().empty())
        if (!read_number(key, lines_.word(), values)) return;
    if (values.size() != 1 && values.size() != 3 && values.size() != bands)
        return error(fmt::format("material '{}': {} has {} values", shown(material_.name), key, values.size()),
                     "give one or three");
    for (std::size_t b = 0; b < values.size(); ++b) {
        const double v = values[b];
        if (reflectance && !(v >= 0 && v <= whitest_reflectance))
            return error(fmt::format("material '{}': reflectance Kd of {} is {:g}, not in [0, 1)",
                                     shown(material_.name), band_name(b, values.size()), v),
                         "a reflectance is at least 0 and below 1, or reflections would never fade");
        if (!reflectance && v < 0)
            return error(fmt::format("material '{}': emission Ke of {} is {:g}, below 0", shown(material_.name),
                                     band_name(b, values.size()), v),
                         "emitted radiance is 0 or more, W/(m^2 sr)");
    }
    material_.*value = reflectance ? spectrum_of_values(values) : exitance_of_radiance(spectrum_of_values(values));
    if (reflectance) reflectance_line_ = lines_.number();
}

bool MtlReader::read_number(const std::string& key, std::string_view word, std::vector<double>& out) {
    double v = 0;
    const NumberKind kind = number_of_word(word, v);
    if (kind == NumberKind::finite) return out.push_back(v), true;
    error(fmt::format("material '{}': '{}' in {} is not a {}number", shown(material_.name), shown(word), key,
                      kind == NumberKind::not_finite ? "finite " : ""));
    return false;
}

}  // namespace

void parse_mtl(std::string_view text, const std::string& file, std::vector<Material>& materials,
               std::vector<Finding>& findings, MtlExtras& extras) {
    MtlReader(text, file, materials, findings, extras).read();
}

}  // namespace exitance
