#pragma once

#include "exitance/io/report/luminaire_schedule.hpp"

namespace exitance {

/// Numbers of a report, computed once for the page and for the JSON file.
struct ReportFigures {
    struct Face {
        SurfaceId surface;
        int line = 0;
        std::string group, material;
        double area = 0;  ///< m^2
        Levels irradiance;
        double radiosity = 0;  ///< Mean.
    };
    struct MaterialUse {
        std::string name;
        std::array<double, 3> reflectance, radiance;
        std::size_t faces = 0;
        double area = 0;        ///< m^2
        double irradiance = 0;  ///< Area-weighted mean irradiance of the material's faces.
    };
    struct Grid {
        const GridLight* light;
        std::vector<double> values;  ///< Value at each point.
        Levels levels;               ///< Statistics of the points that no object covers.
        std::size_t hidden = 0;      ///< Number of covered points.
    };
    std::vector<Face> faces;  ///< Faces, sorted by descending area.
    std::vector<MaterialUse> materials;
    std::vector<Grid> grids;
    LuminaireSchedule luminaires;
    double area = 0;  ///< Total area of the surfaces, m^2.
};

ReportFigures find_figures(const ReportContent& content);

/// Symbol of a unit: "W/m²" or "lx".
const char* symbol(const LightUnit& unit);

/// Formats a number with five significant digits, for pages and files.
std::string figure(double value);

/// Formats a number with three significant digits for narrow cells, without exponents up to a million.
std::string short_figure(double value);

/// Width at which the page shows a drawing of this width and height, pixels: at most 640, and so low that an A4 page
/// has room for two.
double shown_width(double width, double height);

/// Formats the numbers as JSON.
std::string report_json(const ReportContent& content, const ReportFigures& figures);

/// Formats the observers of a report as an item of a JSON array, and as a part of the page (empty if there are none).
std::string observer_json(const ObserverGlare& observer);
std::string observers_html(const ReportContent& content);
/// Escapes text for HTML.
std::string escaped(const std::string& text);

/// Draws a plan of a grid in false colours with isolines, walls and furniture (SVG), with a legend (HTML).
std::string grid_plan(const ReportFigures::Grid& grid, const LightUnit& unit, const Scene& scene);

/// A canvas that shows the scene with its light maps, and the script that rotates it (HTML); empty without maps.
Result<std::string> report_viewer(const ReportContent& content);

/// Encodes a picture as a data: URL.
Result<std::string> data_address(const Image& image);

}  // namespace exitance
