#include "exitance/io/scenes/cityjson.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>

#include "exitance/io/files/text_lines.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/scenes/bridged_holes.hpp"
#include "exitance/io/scenes/gltf/json_shape.hpp"
#include "exitance/io/scenes/json_members.hpp"
#include "exitance/scene/add_polygon.hpp"

namespace exitance {
namespace {

constexpr std::size_t max_depth = 64;  ///< Limit on the nesting of the file; CityJSON needs at most 12 levels.
/// Coordinates above this many metres are moved to the origin. Near 10 km, single precision of rays is 1 mm.
constexpr double far_from_origin = 1e4;

/// A level of detail, which is a number in version 1.0 and text later.
std::string lod_of(const Json& geometry) {
    const Json& lod = member(geometry, "lod");
    return lod.is_number() ? fmt::format("{}", lod.get<double>()) : text_of(lod);
}

double number_of_lod(const std::string& lod) {
    return std::strtod(lod.c_str(), nullptr);
}

class CityJsonReader {
  public:
    CityJsonReader(const std::string& path, const std::string& wanted_lod) : path_(path), wanted_lod_(wanted_lod) {
        out_.description.file = path;
    }

    ReadScene read(const std::string& text) {
        if (shape_of_json(text).depth > max_depth) return error("is nested too deeply for CityJSON"), std::move(out_);
        const Json city = Json::parse(text, nullptr, false);
        if (city.is_discarded()) return error("is not valid JSON"), std::move(out_);
        if (!check_version(city) || !read_vertices(city)) return std::move(out_);
        templates_ = &member(city, "geometry-templates");
        read_templates();
        const Json& objects = member(city, "CityObjects");
        if (!objects.is_object()) return error("has no CityObjects"), std::move(out_);
        for (const auto& [id, object] : objects.items()) read_object(id, object);
        warn();
        move_to_origin();
        return std::move(out_);
    }

  private:
    void find(Finding::Kind kind, std::string message, std::string hint = "") {
        out_.findings.push_back({kind, path_, 0, std::move(message), std::move(hint)});
    }
    void error(std::string message, std::string hint = "") {
        find(Finding::Kind::error, std::move(message), std::move(hint));
    }

    bool check_version(const Json& city) {
        if (text_in(city, "type") != "CityJSON")
            return error("is neither a CityJSON file nor a Honeybee model",
                         "its type must be 'CityJSON' or 'Model'; files of features (CityJSONSeq) are combined to "
                         "CityJSON by the "
                         "program cjio"),
                   false;
        const std::string version = text_in(city, "version");
        if (version.starts_with("1.") || version == "2.0") return true;
        return error(fmt::format("CityJSON version '{}' is not supported", shown(version)), "1.0, 1.1 and 2.0 are"),
               false;
    }

    bool read_vertices(const Json& city) {
        const Json& transform = member(city, "transform");
        const Point scale = vector_of(member(transform, "scale")).value_or(Point{1, 1, 1});
        const Point translate = vector_of(member(transform, "translate")).value_or(Point{});
        const Json& vertices = member(city, "vertices");
        if (!vertices.is_array()) return error("has no vertices"), false;
        for (std::size_t k = 0; k < vertices.size(); ++k) {
            const std::optional<Point> p = vector_of(vertices[k]);
            if (!p) return error(fmt::format("vertex {} is not three finite numbers", k)), false;
            vertices_.push_back(
                {p->x * scale.x + translate.x, p->y * scale.y + translate.y, p->z * scale.z + translate.z});
        }
        return true;
    }

    void read_templates() {
        const Json& vertices = member(*templates_, "vertices-templates");
        if (!vertices.is_array()) return;
        for (const Json& vertex : vertices) template_vertices_.push_back(vector_of(vertex).value_or(Point{}));
    }

    /// Geometry of a template, if `geometry` is an instance; otherwise the geometry itself.
    const Json& resolved(const Json& geometry) const {
        if (text_in(geometry, "type") != "GeometryInstance") return geometry;
        const Json& list = member(*templates_, "templates");
        const Json& index = member(geometry, "template");
        static const Json none;
        if (!index.is_number_unsigned() || !list.is_array() || index.get<std::size_t>() >= list.size()) return none;
        return list[index.get<std::size_t>()];
    }

    void read_object(const std::string& id, const Json& object) {
        const Json& geometries = member(object, "geometry");
        if (!geometries.is_array() || geometries.empty()) return;
        std::string lod = wanted_lod_;
        if (lod.empty()) {
            for (const Json& geometry : geometries) {
                const std::string own = lod_of(resolved(geometry));
                if (lod.empty() || number_of_lod(own) > number_of_lod(lod)) lod = own;
            }
        }
        const std::size_t before = out_.description.faces.size();
        group_ = static_cast<std::uint32_t>(out_.description.groups.size());
        out_.description.groups.push_back(id);
        id_ = id, type_ = text_in(object, "type");
        bool has_lod = false;
        for (const Json& geometry : geometries) {
            const Json& shape = resolved(geometry);
            if (shape.is_null()) {
                error(fmt::format("object '{}' uses a template that does not exist", shown(id)));
                continue;
            }
            if (number_of_lod(lod_of(shape)) != number_of_lod(lod)) continue;  // "2" is "2.0"
            has_lod = true;
            read_geometry(geometry, shape);
        }
        without_lod_ += !has_lod;
        if (out_.description.faces.size() == before) out_.description.groups.pop_back();
    }

    void read_geometry(const Json& geometry, const Json& shape) {
        set_place(geometry, &shape != &geometry);
        const std::string type = text_in(shape, "type");
        const std::size_t depth = type == "MultiSurface" || type == "CompositeSurface" ? 0
                                  : type == "Solid"                                    ? 1
                                  : type == "MultiSolid" || type == "CompositeSolid"   ? 2
                                                                                       : 3;
        if (depth == 3) {
            skipped_ += type == "MultiPoint" || type == "MultiLineString";
            if (type != "MultiPoint" && type != "MultiLineString")
                error(fmt::format("object '{}' has a geometry of unknown type '{}'", shown(id_), shown(type)));
            return;
        }
        const Json& semantics = member(shape, "semantics");
        read_surfaces(member(shape, "boundaries"), member(semantics, "surfaces"), member(semantics, "values"), depth);
    }

    /// Chooses the vertices of a geometry, and for an instance of a template its place.
    void set_place(const Json& geometry, bool is_instance) {
        current_ = is_instance ? &template_vertices_ : &vertices_;
        matrix_.reset();
        if (!is_instance) return;
        std::array<double, 16> matrix{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
        const Json& given = member(geometry, "transformationMatrix");
        if (given.is_array() && given.size() == 16)
            for (std::size_t k = 0; k < 16; ++k) matrix[k] = given[k].is_number() ? given[k].get<double>() : 0;
        const Json& reference = member(geometry, "boundaries");
        if (reference.is_array() && reference.size() == 1 && reference[0].is_number_unsigned() &&
            reference[0].get<std::size_t>() < vertices_.size()) {
            const Point& at = vertices_[reference[0].get<std::size_t>()];
            for (std::size_t k = 0; k < 3; ++k) matrix[4 * k + 3] += at[k];
        } else {
            error(fmt::format("object '{}': the reference point of its template is missing", shown(id_)));
        }
        matrix_ = matrix;
    }

    /// Reads nested lists of surfaces, with their semantic values nested alike.
    void read_surfaces(const Json& boundaries, const Json& kinds, const Json& values, std::size_t depth) {
        if (!boundaries.is_array()) return error(fmt::format("object '{}' has no boundaries", shown(id_)));
        for (std::size_t k = 0; k < boundaries.size(); ++k) {
            static const Json none;
            const Json& value = values.is_array() && k < values.size() ? values[k] : none;
            if (depth > 0)
                read_surfaces(boundaries[k], kinds, value, depth - 1);
            else
                read_surface(boundaries[k], kinds, value);
        }
    }

    std::optional<std::vector<Point>> read_ring(const Json& ring) {
        std::vector<Point> out;
        if (!ring.is_array()) return std::nullopt;
        for (const Json& index : ring) {
            if (!index.is_number_unsigned() || index.get<std::size_t>() >= current_->size()) return std::nullopt;
            out.push_back(placed((*current_)[index.get<std::size_t>()]));
        }
        return out;
    }

    Point placed(const Point& p) const {
        if (!matrix_) return p;
        Point out;
        for (std::size_t k = 0; k < 3; ++k) {
            const double* row = matrix_->data() + 4 * k;
            out[k] = row[0] * p.x + row[1] * p.y + row[2] * p.z + row[3];
        }
        return out;
    }

    void read_surface(const Json& rings, const Json& kinds, const Json& value) {
        std::vector<std::vector<Point>> loops;
        if (rings.is_array())
            for (const Json& ring : rings) {
                std::optional<std::vector<Point>> loop = read_ring(ring);
                if (!loop) return error(fmt::format("object '{}' names a vertex that does not exist", shown(id_)));
                loops.push_back(std::move(*loop));
            }
        if (loops.empty()) return error(fmt::format("object '{}' has a surface without a boundary", shown(id_)));
        std::string kind = type_;
        if (value.is_number_unsigned() && kinds.is_array() && value.get<std::size_t>() < kinds.size())
            kind = text_of(member(kinds[value.get<std::size_t>()], "type"));
        const std::vector<std::vector<Point>> holes(loops.begin() + 1, loops.end());
        add_face(holes.empty() ? loops.front() : bridge_holes(loops.front(), holes), kind);
    }

    void add_face(const std::vector<Point>& outline, const std::string& kind) {
        SceneDescription& d = out_.description;
        const auto [known, is_new] = materials_.try_emplace(kind, static_cast<std::uint32_t>(d.materials.size()));
        if (is_new) d.materials.push_back({kind.empty() ? "default" : kind, Spectrum(0.5), Spectrum()});
        SceneDescription::Face& face = add_polygon(d, outline);
        face.material = known->second, face.group = group_;
    }

    void warn() {
        if (without_lod_ > 0)
            find(Finding::Kind::warning,
                 fmt::format("{} city objects have no geometry of level of detail {}", without_lod_, wanted_lod_),
                 "leave out --lod to read the highest level of each object");
        if (skipped_ > 0)
            find(Finding::Kind::warning, fmt::format("{} geometries are points or lines: they are left out", skipped_));
    }

    /// Subtracts whole metres from far coordinates.
    void move_to_origin() {
        Box box;
        for (const Point& p : out_.description.points) box.add(p);
        if (out_.description.points.empty()) return;
        Point origin{};
        for (std::size_t k = 0; k < 3; ++k)
            if (std::max(std::abs(box.lo[k]), std::abs(box.hi[k])) > far_from_origin) origin[k] = std::floor(box.lo[k]);
        if (origin.x == 0 && origin.y == 0 && origin.z == 0) return;
        for (Point& p : out_.description.points) p = p - Vec3(origin);
        out_.origin = origin;
        find(Finding::Kind::warning, fmt::format("the model was moved: its origin is at ({:.0f}, {:.0f}, {:.0f}) m",
                                                 origin.x, origin.y, origin.z));
    }

    const std::string& path_;
    const std::string& wanted_lod_;
    ReadScene out_;
    std::vector<Point> vertices_, template_vertices_;
    const Json* templates_ = nullptr;
    std::map<std::string, std::uint32_t> materials_;
    const std::vector<Point>* current_ = nullptr;   ///< Vertices of the current geometry.
    std::optional<std::array<double, 16>> matrix_;  ///< Placement of an instance, row by row.
    std::string id_, type_;                         ///< Identifier and type of the current city object.
    std::uint32_t group_ = 0;
    std::size_t without_lod_ = 0, skipped_ = 0;
};

}  // namespace

ReadScene read_cityjson(const std::string& path, const std::string& lod) {
    const Result<std::string> text = read_whole_file(path);
    if (text) return CityJsonReader(path, lod).read(*text);
    return unreadable_scene(path, text.error().message);
}

}  // namespace exitance
