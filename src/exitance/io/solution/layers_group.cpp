#include <algorithm>
#include <cmath>

#include "exitance/io/solution/solution_groups.hpp"
#include "exitance/methods/light/mesh_of_layers.hpp"
#include "exitance/solution/layers/light_layers.hpp"

namespace exitance {
namespace {

using Contents = LightLayer::Contents;

/// All sheets, concatenated.
struct FlatSheets {
    std::vector<std::uint32_t> region, source, counts, faces, wide;
    std::vector<double> colour, box;
    std::vector<std::uint8_t> form;
    std::vector<float> vertices, edges;
    std::vector<std::uint16_t> half_vertices, half_edges, narrow;
};

constexpr std::size_t count_columns = 5, box_columns = 5;

std::uint32_t number(std::size_t count) {
    return static_cast<std::uint32_t>(count);
}

void add(FlatSheets& out, const LightLayers::Sheet& sheet) {
    const Contents& c = sheet.light.contents();
    out.region.push_back(sheet.region.value), out.source.push_back(sheet.source);
    out.colour.insert(out.colour.end(), sheet.colour.value.begin(), sheet.colour.value.end());
    out.form.push_back(static_cast<std::uint8_t>(c.form));
    out.box.insert(out.box.end(), {c.lo.x, c.lo.y, c.size.x, c.size.y, c.scale});
    out.counts.insert(out.counts.end(),
                      {number(c.vertices.size() + c.half_vertices.size()), number(c.edges.size() + c.half_edges.size()),
                       number(c.faces.size()), number(c.narrow.size()), number(c.wide.size())});
    for (const auto& v : c.vertices) out.vertices.insert(out.vertices.end(), {v.u, v.v, v.value});
    for (const auto& e : c.edges) out.edges.push_back(e.value);
    for (const auto& f : c.faces) out.faces.insert(out.faces.end(), f.begin(), f.end());
    for (const auto& v : c.half_vertices) out.half_vertices.insert(out.half_vertices.end(), {v.u, v.v, v.value});
    out.half_edges.insert(out.half_edges.end(), c.half_edges.begin(), c.half_edges.end());
    for (const auto& t : c.narrow) out.narrow.insert(out.narrow.end(), t.begin(), t.end());
    for (const auto& t : c.wide) out.wide.insert(out.wide.end(), t.begin(), t.end());
}

/// Reads consecutive rows; take() returns false at the end.
template <class T>
class RowReader {
  public:
    RowReader(const std::vector<T>& flat, std::size_t columns) : flat_(flat), columns_(columns) {}

    template <class Row>
    bool take(std::size_t count, const Row& row) {
        if (count > (flat_.size() - next_) / columns_) return false;
        for (std::size_t i = 0; i < count; ++i, next_ += columns_) row(&flat_[next_]);
        return true;
    }
    bool is_done() const { return next_ == flat_.size(); }

  private:
    const std::vector<T>& flat_;
    std::size_t columns_, next_ = 0;
};

struct SheetReaders {
    RowReader<float> vertices, edges;
    RowReader<std::uint32_t> faces, wide;
    RowReader<std::uint16_t> half_vertices, half_edges, narrow;

    explicit SheetReaders(const FlatSheets& in)
        : vertices(in.vertices, 3),
          edges(in.edges, 1),
          faces(in.faces, 6),
          wide(in.wide, 3),
          half_vertices(in.half_vertices, 3),
          half_edges(in.half_edges, 1),
          narrow(in.narrow, 3) {}

    bool take(Contents& c, const std::uint32_t* counts) {
        const bool floats = c.form == LightLayer::Form::floats;
        const std::size_t points = counts[0], sides = counts[1];
        return vertices.take(floats ? points : 0, [&](const float* v) {
            c.vertices.push_back({v[0], v[1], v[2]});
        }) && edges.take(floats ? sides : 0, [&](const float* e) {
            c.edges.push_back({LightLayer::unused, *e});
        }) && half_vertices.take(floats ? 0 : points, [&](const std::uint16_t* v) {
            c.half_vertices.push_back({v[0], v[1], v[2]});
        }) && half_edges.take(floats ? 0 : sides, [&](const std::uint16_t* e) {
            c.half_edges.push_back(*e);
        }) && faces.take(counts[2], [&](const std::uint32_t* f) {
            std::copy_n(f, 6, c.faces.emplace_back().begin());
        }) && narrow.take(counts[3], [&](const std::uint16_t* t) {
            std::copy_n(t, 3, c.narrow.emplace_back().begin());
        }) && wide.take(counts[4], [&](const std::uint32_t* t) { std::copy_n(t, 3, c.wide.emplace_back().begin()); });
    }
    bool is_done() const {
        return vertices.is_done() && edges.is_done() && faces.is_done() && wide.is_done() && half_vertices.is_done() &&
               half_edges.is_done() && narrow.is_done();
    }
};

}  // namespace

void write_layers(Hdf5Writer& file, const std::string& group, const Solution& solution) {
    const LightLayers& layers = layers_of(solution);
    if (layers.empty()) return;
    FlatSheets flat;
    for (const LightLayers::Sheet& sheet : layers.sheets) add(flat, sheet);
    std::vector<std::uint32_t> sources;
    for (const RegionId r : layers.sources) sources.push_back(r.value);
    const auto in = [&](const char* name) { return group + "/" + name; };
    file.make_group(group);
    file.write(in("sources"), sources, 1, {"1", "region that emits; 4294967295: all others together"});
    std::vector<double> factors;
    std::vector<std::string> groups = layers.groups;
    groups.resize(layers.sources.size());
    for (std::uint32_t i = 0; i < layers.sources.size(); ++i) factors.push_back(layers.factor(i));
    file.write(in("factor"), factors, 1, {"1", "factor by which a source is dimmed"});
    file.write_texts(in("group"), groups, {"1", "light group of each source; empty: unknown or several"});
    file.write_text(in("mesh"), layers.mesh, {"1", "options of the single mesh, an option a line"});
    file.write(in("region"), flat.region, 1, {"1", "region of a sheet"});
    file.write(in("source"), flat.source, 1, {"1", "row in sources of a sheet"});
    file.write(in("colour"), flat.colour, bands, {"1", "irradiance by bands for a value of 1"});
    file.write(in("form"), flat.form, 1, {"1", "of a sheet: 0 floats, 1 half floats"});
    file.write(in("box"), flat.box, box_columns, {"m", "of a sheet: least u, v; width, height; scale, W/m^2"});
    file.write(in("counts"), flat.counts, count_columns,
               {"1", "of a sheet: vertices, edges, and triangles in faces, narrow, wide"});
    // Sets of the other form are left out.
    const auto write = [&](const char* name, const auto& values, std::size_t columns, Hdf5Label label) {
        if (!values.empty()) file.write(in(name), values, columns, label);
    };
    write("vertices", flat.vertices, 3, {"m", "u, v, and irradiance there, W/m^2"});
    write("edges", flat.edges, 1, {"W/m^2", "irradiance at the middle of an edge"});
    write("faces", flat.faces, 6, {"1", "vertices of a triangle, then its edges 01, 12, 20"});
    write("half_vertices", flat.half_vertices, 3,
          {"1", "u, v in 65535ths of the box, and bits of a half float, in scales"});
    write("half_edges", flat.half_edges, 1, {"1", "bits of a half float, at the middle of an edge, in scales"});
    write("narrow", flat.narrow, 3, {"1", "vertices of a triangle"});
    write("wide", flat.wide, 3, {"1", "vertices of a triangle"});
}

namespace {

/// Reads what files of older programs lack: factors and groups of the sources, and the options of the single mesh.
void read_sources(Hdf5Reader& file, const std::string& group, LightLayers& out) {
    const auto in = [&](const char* name) { return group + "/" + name; };
    if (!file.has(in("factor"))) return;
    out.factors = file.read<double>(in("factor"), 1, out.sources.size());
    for (const double factor : out.factors)
        if (!(factor >= 0) || !std::isfinite(factor)) return file.fail(in("factor"), "is not a factor");
    out.groups = file.read_texts(in("group"), out.sources.size());
    out.mesh = file.read_text(in("mesh"));
    if (const Result<SolveOptions> options = read_mesh_options(out.mesh); !options)
        file.fail(in("mesh"), options.error().message);
}

}  // namespace

void read_layers(Hdf5Reader& file, const std::string& group, Solution& solution) {
    const std::size_t region_count = solution.scene.regions().size();
    const auto in = [&](const char* name) { return group + "/" + name; };
    FlatSheets flat;
    const auto sources = file.read<std::uint32_t>(in("sources"));
    flat.region = file.read<std::uint32_t>(in("region"));
    const std::size_t sheets = flat.region.size();
    flat.source = file.read<std::uint32_t>(in("source"), 1, sheets);
    flat.colour = file.read<double>(in("colour"), bands, sheets);
    flat.form = file.read<std::uint8_t>(in("form"), 1, sheets);
    flat.box = file.read<double>(in("box"), box_columns, sheets);
    flat.counts = file.read<std::uint32_t>(in("counts"), count_columns, sheets);
    const auto read = [&]<class T>(const char* name, std::vector<T>& values, std::size_t columns) {
        if (file.has(in(name))) values = file.read<T>(in(name), columns);
    };
    read("vertices", flat.vertices, 3), read("edges", flat.edges, 1), read("faces", flat.faces, 6);
    read("half_vertices", flat.half_vertices, 3), read("half_edges", flat.half_edges, 1);
    read("narrow", flat.narrow, 3), read("wide", flat.wide, 3);
    if (file.failed()) return;
    const auto wrong = [&](const std::string& what) { return file.fail(in("counts"), what); };
    LightLayers out;
    for (const std::uint32_t r : sources) {
        out.sources.emplace_back(r);
        if (!out.sources.back().is_none() && r >= region_count) return wrong("comes from a region that does not exist");
    }
    read_sources(file, group, out);
    if (file.failed()) return;
    SheetReaders readers(flat);
    for (std::size_t s = 0; s < sheets; ++s) {
        Contents c;
        const double* box = &flat.box[box_columns * s];
        c.form = flat.form[s] == 0 ? LightLayer::Form::floats : LightLayer::Form::halves;
        c.lo = {box[0], box[1]}, c.size = {box[2], box[3]}, c.scale = box[4];
        Spectrum colour;
        std::copy_n(&flat.colour[bands * s], bands, colour.value.begin());
        const bool in_order = s == 0 || flat.region[s - 1] <= flat.region[s];
        if (flat.region[s] >= region_count || flat.source[s] >= sources.size() || !in_order || flat.form[s] > 1 ||
            !is_finite(colour) || !readers.take(c, &flat.counts[count_columns * s]))
            return wrong("makes no sense");
        if (const auto nonsense = find_nonsense(c)) return wrong(*nonsense);
        out.sheets.push_back({RegionId(flat.region[s]), flat.source[s], colour, LightLayer(std::move(c))});
        out.sheets.back().light.make_grid();
    }
    if (!readers.is_done()) return wrong("leaves something over");
    solution.layers = std::make_shared<LayersForm>(std::move(out));
}

}  // namespace exitance
