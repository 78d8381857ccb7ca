#pragma once

#include <map>
#include <string>
#include <vector>

#include "exitance/scene/findings.hpp"
#include "exitance/scene/joining/face_mesh.hpp"
#include "exitance/scene/joining/regions.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// Builds a scene step by step and collects findings.
class SceneBuilder {
  public:
    /// `turn_bodies`: if true, closed bodies that are inside out (`find_inside_out`) are reversed.
    explicit SceneBuilder(SceneDescription description, bool turn_bodies = false)
        : in_(std::move(description)), turn_bodies_(turn_bodies) {}
    CheckedScene build();

  private:
    void check_materials();
    void check_lights();
    void place_corners();
    void check_faces();
    void check_face(std::uint32_t f);
    void check_shape(std::uint32_t f, std::vector<std::uint32_t> outline);
    /// Corners, area vector (m^2) and size of an outline.
    struct OutlineShape {
        std::vector<Point> corners;
        Vec3 area;
        double extent = 0;  ///< Diagonal of the face's bounding box, metres.

        OutlineShape(std::span<const Point> points, std::span<const std::uint32_t> outline);
    };
    /// Returns the width (metres) below which no ray hits the outline, because single precision does not resolve it
    /// relative to its length.
    double narrowest_width(const OutlineShape& shape) const;
    bool is_too_narrow(const OutlineShape& shape) const;
    /// Adds the parts of a self-intersecting outline.
    void split_crossed(std::uint32_t f, std::span<const std::uint32_t> outline);
    /// Adds an outline without self-intersections; splits it into triangles if it is not planar.
    void add_shape(std::uint32_t f, std::span<const std::uint32_t> outline, const OutlineShape& shape);
    /// Appends the outlines of panes to the faces, so that they are checked in the same way.
    void add_pane_faces();
    bool is_pane(std::uint32_t f) const { return f >= first_pane_face_; }
    /// True if there are neither faces nor panes but light from outside, which points in the open receive.
    bool is_sky_alone() const { return in_.faces.empty() && in_.panes.empty() && !in_.distant.empty(); }
    void check_panes();
    void add_face(std::uint32_t f, std::span<const std::uint32_t> outline, const Vec3& area);
    /// True if the corners are out of plane by more than the tolerance that also applies to the tilt of neighbours.
    bool is_bent(std::span<const Point> corners, const Normal& n, double extent) const;
    /// Splits four corners that cross only because they are not planar into two triangles, along the diagonal that
    /// gives the larger ones.
    bool split_folded(std::uint32_t f, std::span<const std::uint32_t> outline, std::span<const Point> corners);
    /// Adds the triangle of three corners of an outline, if it has an area.
    void add_triangle(std::uint32_t f, std::span<const std::uint32_t> outline, std::span<const Point> corners,
                      const std::array<std::size_t, 3>& t);
    void report_flattened();
    void drop_duplicates();
    void turn_bodies();
    void check_light();
    Scene make();
    void add_other_sides();
    void pair_sides(Scene& scene);
    void add_regions(Scene& scene, const std::vector<JoinedFaces>& joined);

    void find(Finding::Kind kind, int line, std::string message, std::string hint = "") {
        findings_.push_back({kind, in_.file, line, std::move(message), std::move(hint)});
    }
    void error(int line, std::string message, std::string hint = "") {
        find(Finding::Kind::error, line, std::move(message), std::move(hint));
    }
    /// Adds a finding about a face, identified by its line or, in files without lines, by its group; marked as `mark`.
    /// Findings with the same `rest` ("faces without area") are reported once, with the number of the others.
    void find(Finding::Kind kind, const SceneDescription::Face& face, Mark::Kind mark, std::string message,
              std::string hint = "", const char* rest = nullptr);
    void repair(const SceneDescription::Face& face, std::string message, const char* rest, std::string hint = "") {
        find(Finding::Kind::repair, face, Mark::Kind::left_out, std::move(message), std::move(hint), rest);
    }
    void error(const SceneDescription::Face& face, std::string message, std::string hint = "") {
        find(Finding::Kind::error, face, Mark::Kind::broken, std::move(message), std::move(hint));
    }
    void report_alike();
    void stack_overlaps(Scene& scene);
    std::string name_of(const SceneDescription::Face& face) const;
    bool has_errors() const { return exitance::has_errors(findings_); }

    SceneDescription in_;
    bool turn_bodies_;
    std::vector<Finding> findings_;
    std::vector<std::uint32_t> place_;  // for every point: the first point at the same position
    Tolerances tol_;
    FaceMesh mesh_;
    std::vector<std::uint32_t> origin_;  // face of the mesh -> face of the description
    std::uint32_t first_pane_face_ = 0;  // the faces of the description from here on are outlines of panes
    std::vector<Pane> panes_;            // checked
    Box box_;
    /// Faces that were out of plane by more than rounding, but within the tolerance.
    struct Flattened {
        std::size_t count = 0;
        double farthest = 0;  ///< m
        int first_line = 0;
    } flattened_;
    std::vector<Mark> marks_;
    struct Alike {
        std::size_t finding, more = 0;
        std::string rest;
    };
    std::map<std::string, Alike> alike_;  ///< Key: kind or message. Index of the first finding, number of others.
};

}  // namespace exitance
