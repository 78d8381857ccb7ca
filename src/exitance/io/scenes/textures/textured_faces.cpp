#include "exitance/io/scenes/textures/textured_faces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "exitance/base/limits.hpp"
#include "exitance/base/polygon.hpp"
#include "exitance/scene/material_name.hpp"

namespace exitance {
namespace {

constexpr int code_tolerance = 2;  ///< Tolerance of colours, in codes of 256.

/// Area of a face, m^2.
double area_of(const SceneDescription& d, const SceneDescription::Face& face) {
    std::vector<Point> corners;
    for (const std::uint32_t c : face.corners) corners.push_back(d.points[c]);
    return norm(area_vector(corners));
}

/// True if a quantity varies by more than the tolerance of colours, relative to the value `whole` of the material.
bool varies(const ColourRange& range, const Spectrum& whole) {
    const double brightest = std::max(1.0, max(whole));
    for (std::size_t b = 0; b < bands; ++b)
        if (srgb_code(range.highest[b] / brightest) - srgb_code(range.lowest[b] / brightest) > code_tolerance)
            return true;
    return false;
}

}  // namespace

void TexturedFaces::Variation::add(const ColourRange& range, double of, bool varies, const std::string& name) {
    const double own = of * mean(range.deviation * range.deviation);
    area += of, squares += own, sum += of * mean(range.mean);
    faces += varies;
    if (!varies || own <= largest) return;
    largest = own, material = name;
    std::size_t widest = 0;
    for (std::size_t b = 1; b < bands; ++b)
        if (range.deviation[b] > range.deviation[widest]) widest = b;
    lowest = range.lowest[widest], highest = range.highest[widest];
}

void TexturedFaces::show(std::size_t face, FaceColours colours) {
    const Material& material = out_->materials[out_->faces[face].material];
    std::vector<std::uint32_t> corners(out_->faces[face].corners.size());
    std::iota(corners.begin(), corners.end(), 0u);
    const PartColour colour = part_colour(material, colours, corners, whitest_);
    const double area = area_of(*out_, out_->faces[face]);
    const bool is_even =
        !varies(colour.reflectance, material.reflectance) && !varies(colour.exitance, material.exitance);
    if (colour.coverage >= 1 && (is_even || max_parts_ == 0)) return add(face, colour, area);
    keep({static_cast<std::uint32_t>(face), std::move(colours), colour, area});
}

/// Keeps a face for cutting; drops those of least effect if there are too many.
void TexturedFaces::keep(VaryingFace face) {
    varying_.push_back(std::move(face));
    if (varying_.size() < next_trim_) return;
    const auto effect = [](const VaryingFace& f) {
        const ColourRange &r = f.colour.reflectance, &m = f.colour.exitance;
        const double emitted = max(m.mean) > 0 ? mean(m.deviation * m.deviation) / mean(m.mean * m.mean) : 0;
        // Faces with holes are never dropped, since some of them may have to be omitted.
        return f.colour.coverage < 1 ? HUGE_VAL : f.area * (mean(r.deviation * r.deviation) + emitted);
    };
    const auto last = varying_.begin() + max_varying;
    std::nth_element(varying_.begin(), last, varying_.end(), [&](const VaryingFace& a, const VaryingFace& b) {
        const double ea = effect(a), eb = effect(b);
        return ea != eb ? ea > eb : a.face < b.face;
    });
    const auto dropped =
        std::stable_partition(last, varying_.end(), [](const VaryingFace& f) { return f.colour.coverage < 1; });
    for (auto f = dropped; f != varying_.end(); ++f) add(f->face, f->colour, f->area);
    varying_.erase(dropped, varying_.end());
    next_trim_ = 2 * varying_.size();
}

void TexturedFaces::add(std::size_t face, const PartColour& colour, double area) {
    const std::uint32_t own = out_->faces[face].material;
    const Material& material = out_->materials[own];
    const double brightest = std::max(max(material.exitance), min_divisor);
    const Spectrum &reflectance = colour.reflectance.mean, &exitance = colour.exitance.mean;
    reflects_.add(colour.reflectance, area, varies(colour.reflectance, material.reflectance), material.name);
    if (material.emits()) emits_.add(colour.exitance, area, varies(colour.exitance, material.exitance), material.name);
    const Spectrum& deviation = colour.reflectance.deviation;
    const auto add_squares = [&](Sum& sum) {
        sum.squares += area * (reflectance * reflectance + deviation * deviation), sum.area += area;
    };
    Key key = {static_cast<int>(own)};
    bool differs = false;
    const auto add_code = [&](double shown, double whole) {
        differs |= std::abs(srgb_code(shown) - srgb_code(whole)) > code_tolerance;
        key.push_back(srgb_code(shown) / code_tolerance);
    };
    for (std::size_t b = 0; b < bands; ++b) add_code(reflectance[b], material.reflectance[b]);
    for (std::size_t b = 0; b < bands; ++b) add_code(exitance[b] / brightest, material.exitance[b] / brightest);
    if (!differs) {
        Sum& sum = unchanged_[own];
        sum.reflectance += area * reflectance;
        return add_squares(sum);
    }
    Sum& sum = sums_[key];
    sum.reflectance += area * reflectance, sum.exitance += area * exitance;
    add_squares(sum);
    sum.faces.push_back(face);
}

/// Computes the RMS deviation from the material's mean m by E (r - m)^2 = E r^2 - 2 m E r + m^2.
void TexturedFaces::set_deviation(std::size_t material, const Sum& sum, const Spectrum& mean) {
    if (deviation_.size() <= material) deviation_.resize(material + 1);
    constexpr double rounding = 1e-12;  // relative rounding error of the second moment
    for (std::size_t b = 0; b < bands; ++b) {
        const double second = sum.squares[b] / sum.area, first = sum.reflectance[b] / sum.area;
        const double about_mean = second - 2 * mean[b] * first + mean[b] * mean[b];
        deviation_[material][b] = about_mean > rounding * second ? std::sqrt(about_mean) : 0;
    }
}

namespace {

/// Corners of the other side of a face, from the smallest on.
std::vector<std::uint32_t> turned(std::vector<std::uint32_t> corners) {
    std::reverse(corners.begin(), corners.end());
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    return corners;
}

/// True if two faces are the sides of one sheet.
bool are_sides(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b) {
    return a.size() == b.size() && !a.empty() && turned(turned(a)) == turned(b);
}

}  // namespace

/// Cuts both sides of a face alike: a side that stays whole would close the holes of the other.
void TexturedFaces::cut_backs_like_fronts(CutFaces& cut) const {
    for (std::size_t back = 1; back < varying_.size(); ++back) {
        const std::size_t front = back - 1;
        const SceneDescription::Face &a = out_->faces[varying_[front].face], &b = out_->faces[varying_[back].face];
        if (!(cut.is_cut[front] || cut.is_cut[back]) || a.material != b.material || !are_sides(a.corners, b.corners))
            continue;
        const auto [from, to] = cut.is_cut[front] ? std::pair(front, back) : std::pair(back, front);
        cut.parts[to] = cut.parts[from], cut.is_cut[to] = 1;
        for (FacePart& part : cut.parts[to]) part.corners = turned(part.corners);
    }
}

bool TexturedFaces::stays(const VaryingFace& face) {
    const double coverage = face.colour.coverage;
    if (coverage >= 1) return true;
    std::vector<std::uint32_t> corners = out_->faces[face.face].corners;
    // The back of a face, which follows it, stays if the face does.
    const bool is_back = are_sides(corners, holes_.before);
    double& balance = holes_.balance[out_->faces[face.face].material];
    if (!is_back) {
        balance += coverage * face.area;
        holes_.before_stays = coverage > 0 && balance >= 0.5 * face.area;
        if (holes_.before_stays) balance -= face.area;
    }
    holes_.before = std::move(corners);
    holes_.misplaced += face.area * (holes_.before_stays ? 1 - coverage : coverage);
    return holes_.before_stays;
}

void TexturedFaces::replace_cut_faces() {
    std::sort(varying_.begin(), varying_.end(),
              [](const VaryingFace& a, const VaryingFace& b) { return a.face < b.face; });
    CutFaces cut =
        cut_textured_faces(*out_, varying_, whitest_, max_parts_.value_or(default_texture_parts(out_->faces.size())));
    cut_backs_like_fronts(cut);
    const std::vector<std::vector<FacePart>>& parts = cut.parts;
    holes_.misplaced += cut.misplaced;
    for (std::size_t v = 0; v < varying_.size(); ++v) {
        const bool has_holes = varying_[v].colour.coverage < 1;
        holes_.faces += has_holes, holes_.area += has_holes ? varying_[v].area : 0;
        if (cut.is_cut[v]) continue;
        holes_.uncut += has_holes && varying_[v].colour.coverage > 0;
        if (!stays(varying_[v])) cut.is_cut[v] = 1;  // replaces the face by no parts, so that it is omitted
    }
    std::vector<SceneDescription::Face> faces;
    std::vector<std::size_t> place(out_->faces.size());  // index of each face in the new list
    std::vector<std::size_t> first_part(varying_.size());
    std::size_t next = 0;
    for (std::size_t f = 0; f < out_->faces.size(); ++f) {
        place[f] = faces.size();
        const bool is_varying = next < varying_.size() && varying_[next].face == f;
        if (is_varying) first_part[next] = faces.size();
        if (is_varying && cut.is_cut[next]) {
            SceneDescription::Face part = out_->faces[f];
            part.whole = static_cast<std::uint32_t>(f + 1);
            for (const FacePart& p : parts[next]) part.corners = p.corners, faces.push_back(part);
            if (!parts[next].empty()) ++cut_faces_, parts_ += parts[next].size();
        } else {
            faces.push_back(std::move(out_->faces[f]));
        }
        next += is_varying;
    }
    out_->faces = std::move(faces);
    for (auto& [key, sum] : sums_)
        for (std::size_t& f : sum.faces) f = place[f];
    for (std::size_t v = 0; v < varying_.size(); ++v) {
        if (!cut.is_cut[v]) add(first_part[v], varying_[v].colour, varying_[v].area);
        for (std::size_t k = 0; k < parts[v].size(); ++k) add(first_part[v] + k, parts[v][k].colour, parts[v][k].area);
    }
    varying_.clear();
}

void TexturedFaces::finish() {
    if (!varying_.empty()) replace_cut_faces();
    for (const auto& [key, sum] : sums_) {
        if (!(sum.area > 0)) continue;  // skip materials without area, whose mean is not defined
        Material material = out_->materials[static_cast<std::size_t>(key[0])];
        material.reflectance = sum.reflectance / sum.area, material.exitance = sum.exitance / sum.area;
        material.name = name_with_colour(
            material.name, material.emits() ? material.exitance / max(material.exitance) : material.reflectance);
        for (const std::size_t f : sum.faces)
            out_->faces[f].material = static_cast<std::uint32_t>(out_->materials.size());
        set_deviation(out_->materials.size(), sum, material.reflectance);
        out_->materials.push_back(std::move(material));
    }
    for (const auto& [material, sum] : unchanged_)
        if (sum.area > 0) set_deviation(material, sum, out_->materials[material].reflectance);
    sums_.clear(), unchanged_.clear();
}

std::optional<Finding> TexturedFaces::finding() const {
    if (reflects_.faces == 0 && emits_.faces == 0) return std::nullopt;
    const auto says = [](const Variation& v, const char* quantity, const char* unit) {
        return fmt::format(
            "{} varies within {} by {:.3g}% of its mean (RMS), most in '{}': from {:.3g} to {:.3g}{}", quantity,
            v.faces == 1 ? "1 face or part of a face" : fmt::format("{} faces and parts of faces", v.faces),
            v.sum > 0 ? 100 * std::sqrt(v.squares * v.area) / v.sum : 0.0, v.material, v.lowest, v.highest, unit);
    };
    std::string message = reflects_.faces > 0 ? says(reflects_, "reflectance", "") : "";
    if (emits_.faces > 0) message += (message.empty() ? "" : "; ") + says(emits_, "emission", " W/m^2");
    message += "; its mean is used";
    if (cut_faces_ > 0)
        message +=
            fmt::format(" ({} {} cut into {} parts)", cut_faces_, cut_faces_ == 1 ? "face was" : "faces were", parts_);
    return Finding{Finding::Kind::warning, "", 0, std::move(message),
                   "use more --texture-parts where this matters; the error estimate includes variation of reflectance, "
                   "not of emission"};
}

std::optional<Finding> TexturedFaces::finding_of_holes() const {
    if (holes_.faces == 0) return std::nullopt;
    std::string message = fmt::format(
        "{} with holes, by opacity, {} cut or left out; as much area stays as the pictures cover",
        holes_.faces == 1 ? "1 face" : fmt::format("{} faces", holes_.faces), holes_.faces == 1 ? "is" : "are");
    constexpr double rounding = 1e-9;  // derived from the rounding of sums in double precision
    if (holes_.misplaced > rounding * holes_.area)
        message += fmt::format(", but {:.3g}% of it is not where it should be", 100 * holes_.misplaced / holes_.area);
    if (holes_.uncut > 0) message += fmt::format("; {} of them stay or go as a whole", holes_.uncut);
    return Finding{Finding::Kind::warning, "", 0, std::move(message),
                   "use more --texture-parts where the shape of shadows matters"};
}

}  // namespace exitance
