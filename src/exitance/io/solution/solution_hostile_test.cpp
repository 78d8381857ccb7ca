#include <gtest/gtest.h>

#include <limits>

#include "exitance/io/export/export.hpp"
#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/solution/hdf5_file.hpp"
#include "exitance/io/solution/solution_file.hpp"
#include "exitance/io/solution/solution_groups.hpp"
#include "exitance/mesh/element_locator.hpp"
#include "fuzz/solution_target.hpp"
#include "support/run.hpp"
#include "support/sample_solution.hpp"

namespace exitance {
namespace {

constexpr Hdf5Label hostile_label = {"1", "made up"};

/// The data of a file with one square split into four. Tests change one of them.
struct Parts {
    std::vector<std::uint32_t> parent = {0xffffffffu, 0, 0, 0, 0}, root_region = {0};
    std::vector<std::uint8_t> cut = {3, 0, 0, 0, 0}, root_shape = {0};
    std::vector<std::uint8_t> root_corner = {255, 255, 255};  // the patch is in root_patch
    std::vector<double> ratio = {0.5, 0.5, 0.5, 0.5, 0.5}, root_patch = {0, 0, 0, 1, 0, 0, 0, 1, 0}, line, fan;
    std::vector<std::uint32_t> line_element, fan_element, fan_places;
    std::vector<float> values = std::vector<float>(16 * bands, 1);

    std::string wrong(const std::string& path) const {
        Hdf5Writer out(path);
        out.make_group("f");
        out.write("f/parent", parent, 1, hostile_label);
        out.write("f/cut", cut, 1, hostile_label);
        out.write("f/ratio", ratio, 1, hostile_label);
        out.write("f/line_element", line_element, 1, hostile_label);
        out.write("f/line", line, 3, hostile_label);
        out.write("f/fan_element", fan_element, 1, hostile_label);
        out.write("f/fan_places", fan_places, 1, hostile_label);
        out.write("f/fan", fan, 2, hostile_label);
        out.write("f/root_region", root_region, 1, hostile_label);
        out.write("f/root_shape", root_shape, 1, hostile_label);
        out.write("f/root_corner", root_corner, 3, hostile_label);
        out.write("f/root_patch", root_patch, 9, hostile_label);
        out.write("f/values", values, bands, hostile_label);
        if (!out.commit()) return "cannot write";
        Result<Hdf5Reader> in = Hdf5Reader::open(path);
        if (!in) return "cannot open";
        Field<RegionId, Region> regions;
        Region square;
        square.loops = {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}};
        regions.add(std::move(square));
        read_function(*in, "f", regions);
        return in->failed() ? in->error().message.substr(in->error().message.find("data set")) : "";
    }
};

TEST(HostileSolutions, WithInvalidTreesAreErrors) {
    const TemporaryFolder folder;
    const auto outcome = [&](const auto& change) {
        Parts p;
        change(p);
        return p.wrong(folder / "f.h5");
    };
    EXPECT_EQ(outcome([](Parts&) {}), "");
    EXPECT_EQ(outcome([](Parts& p) { p.parent[1] = 7; }), "data set f/parent makes no tree at element 1");
    EXPECT_EQ(outcome([](Parts& p) { p.parent[0] = 0; }), "data set f/parent makes no tree at element 0");
    EXPECT_EQ(outcome([](Parts& p) { p.parent[4] = 1; }), "data set f/parent makes no tree at element 1");
    EXPECT_EQ(outcome([](Parts& p) { p.cut[0] = 0; }), "data set f/parent makes no tree at element 1");
    EXPECT_EQ(outcome([](Parts& p) { p.cut[0] = 9; }), "data set f/parent makes no tree at element 1");
    EXPECT_EQ(outcome([](Parts& p) { p.cut[0] = 4; }), "data set f/parent makes no tree at element 1");
    EXPECT_EQ(outcome([](Parts& p) { p.cut[3] = 1; }), "data set f/parent lacks the children of element 3");
    EXPECT_EQ(outcome([](Parts& p) { p.ratio[0] = 1; }), "data set f/parent makes no tree at element 1");
    EXPECT_EQ(outcome([](Parts& p) { p.ratio[0] = NAN; }), "data set f/parent makes no tree at element 1");
    EXPECT_EQ(outcome([](Parts& p) { p.ratio.pop_back(); }), "data set f/ratio has 4 rows instead of 5");
    EXPECT_EQ(outcome([](Parts& p) { p.root_region[0] = 1; }), "data set f/parent makes no tree at element 0");
    EXPECT_EQ(outcome([](Parts& p) { p.root_shape[0] = 2; }), "data set f/parent makes no tree at element 0");
    EXPECT_EQ(outcome([](Parts& p) { p.root_patch[4] = INFINITY; }), "data set f/parent makes no tree at element 0");
    const auto by_corners = [](Parts& p) { p.root_corner = {0, 1, 3}, p.root_patch.clear(); };
    EXPECT_EQ(outcome(by_corners), "");
    EXPECT_EQ(outcome([&](Parts& p) { by_corners(p), p.root_corner[2] = 4; }),
              "data set f/parent makes no tree at element 0");
    EXPECT_EQ(outcome([&](Parts& p) { by_corners(p), p.root_corner[2] = 1; }),
              "data set f/parent makes no tree at element 0");  // corners on a line
    EXPECT_EQ(outcome([](Parts& p) { p.root_patch.clear(); }), "data set f/parent makes no tree at element 0");
    EXPECT_EQ(outcome([](Parts& p) { p.root_patch.insert(p.root_patch.end(), 9, 1.0); }),
              "data set f/parent has fewer roots than patches");
    EXPECT_EQ(outcome([](Parts& p) { p.root_region.push_back(0); }), "data set f/root_shape has 1 rows instead of 2");
    EXPECT_EQ(outcome([](Parts& p) { p.values.resize(15 * bands); }), "data set f/values has 15 rows instead of 16");
}

TEST(HostileSolutions, WithLinesThatMissTheirElementAreErrors) {
    const TemporaryFolder folder;
    Parts p;
    p.parent = {0xffffffffu, 0, 0}, p.cut = {4, 0, 0}, p.ratio = {0.5, 0.5, 0.5};
    p.line_element = {0}, p.values.resize(8 * bands);
    p.line = {1, 1, 0.7};
    EXPECT_EQ(p.wrong(folder / "f.h5"), "");
    for (const std::vector<double>& line : {std::vector<double>{1, 1, 7}, {NAN, 1, 0.7}, {0, 0, 0}, {1, 0, 1}}) {
        p.line = line;
        EXPECT_EQ(p.wrong(folder / "f.h5"), "data set f/parent makes no tree at element 1");
    }
}

TEST(HostileSolutions, WithInvalidFansAreErrors) {
    const TemporaryFolder folder;
    Parts good;
    good.parent = {0xffffffffu, 0, 0, 0}, good.cut = {5, 0, 0, 0}, good.ratio = {0.5, 0.5, 0.5, 0.5};
    good.fan_element = {0}, good.fan_places = {5}, good.fan = {0.5, 0, 1, 0, 1, 1, 0, 1, 0, 0};
    good.values.resize(9 * bands);
    const auto outcome = [&](const auto& change) {
        Parts p = good;
        change(p);
        return p.wrong(folder / "f.h5");
    };
    const std::string no_tree = "data set f/parent makes no tree at element 1";
    EXPECT_EQ(outcome([](Parts&) {}), "");
    EXPECT_EQ(outcome([](Parts& p) { p.fan_element = {1}; }), no_tree);
    EXPECT_EQ(outcome([](Parts& p) { p.fan_element = {}, p.fan_places = {}; }), no_tree);
    EXPECT_EQ(outcome([](Parts& p) { p.fan_places = {6}; }), no_tree);
    EXPECT_EQ(outcome([](Parts& p) { p.fan_places = {2}; }), no_tree);
    EXPECT_EQ(outcome([](Parts& p) { p.fan_places = {4294967295u}; }), no_tree);
    EXPECT_EQ(outcome([](Parts& p) { p.fan[3] = NAN; }), no_tree);
    EXPECT_EQ(outcome([](Parts& p) { p.fan[2] = 1e300; }), no_tree);
    EXPECT_EQ(outcome([](Parts& p) { std::swap(p.fan[2], p.fan[6]); }), no_tree);  // clockwise
    EXPECT_EQ(outcome([](Parts& p) { p.parent[3] = 1; }), no_tree);
}

TEST(HostileSolutions, RepeatedlySplitSliversAreAccepted) {
    // Triangles such as a solve makes by repeatedly halving thin ones, whose areas are inaccurate.
    Solution s = sample_solution();
    RandomStream random(3, Stream::mesh);
    s.indirect = sample_function(s.scene, 1, 0);
    const Vec3 a{0.3, 0.7, 0};
    ElementId e = s.indirect.tree.add_root(RegionId(std::size_t(0)),
                                           {{0.2, 0.1, 0}, a, 1.1 * a + Vec3{0, 1e-11, 0}, Patch::Shape::triangle});
    for (int depth = 0; depth < 12; ++depth) {
        const Vec2 n = {random.uniform() - 0.5, random.uniform() - 0.5};
        e = s.indirect.tree.split_by_line(e, {n, dot(n, s.indirect.tree.centre(e))});
        ASSERT_FALSE(e.is_none());
    }
    s.indirect.values.clear();
    s.indirect.first_value.resize(s.indirect.tree.size(), 0);
    for (ElementId leaf : s.indirect.tree.leaves()) {
        s.indirect.first_value[leaf] = static_cast<std::uint32_t>(s.indirect.values.size());
        s.indirect.values.resize(s.indirect.values.size() +
                                 static_cast<std::size_t>(s.indirect.tree.patch(leaf).corner_count()));
    }
    const TemporaryFolder folder;
    ASSERT_TRUE(write_solution(folder / "s.h5", s));
    const Result<Solution> back = load_solution(folder / "s.h5");
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(back->indirect.tree.size(), s.indirect.tree.size());
}

TEST(HostileSolutions, WithElementsOutsideTheSceneAreErrors) {
    const TemporaryFolder folder;
    const auto outcome = [&](const auto& change) {
        Solution s = sample_solution();
        change(s);
        EXPECT_TRUE(write_solution(folder / "s.h5", s));
        const Result<Solution> back = load_solution(folder / "s.h5");
        return back ? std::string() : back.error().message;
    };
    EXPECT_EQ(outcome([](Solution&) {}), "");
    const auto with_root = [](const Patch& patch) {
        return [patch](Solution& s) {
            ElementTree tree;
            for (ElementId root : s.indirect.tree.roots())
                tree.add_root(s.indirect.tree.region(root), root.value == 0 ? patch : s.indirect.tree.patch(root));
            s.indirect = {tree, Field<ElementId, std::uint32_t>(tree.size()), {}};
            for (ElementId e : tree.ids()) {
                s.indirect.first_value[e] = static_cast<std::uint32_t>(s.indirect.values.size());
                s.indirect.values.resize(s.indirect.values.size() +
                                         static_cast<std::size_t>(tree.patch(e).corner_count()));
            }
        };
    };
    const Patch good = sample_solution().indirect.tree.patch(ElementId(std::size_t(0)));
    EXPECT_EQ(outcome(with_root(good)), "");
    Patch bad = good;
    bad.origin.z += 1;
    EXPECT_NE(outcome(with_root(bad)).find("does not lie on its region"), std::string::npos);
    bad = good, bad.a = 1e150 * good.a;
    EXPECT_NE(outcome(with_root(bad)), "");
    bad = good, bad.b = bad.a;  // a patch without area has no coordinates
    EXPECT_NE(outcome(with_root(bad)).find("makes no tree at element 0"), std::string::npos);
}

TEST(HostileSolutions, AreDarkAtNonFinitePoints) {
    // Rays may hit such points if a scene is damaged.
    const Solution s = sample_solution();
    const ElementLocator locator(s.indirect.tree, s.scene.regions().size());
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (RegionId r : s.scene.regions().ids()) EXPECT_EQ(s.indirect.at(locator.find(r, {nan, nan, nan})), Spectrum());
}

TEST(Hdf5Writers, WriteRowsAndArraysEqually) {
    const TemporaryFolder folder;
    std::vector<double> values(3 * 50000);  // several chunks, the last one incomplete
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::sqrt(static_cast<double>(i));
    for (const bool by_rows : {false, true}) {
        Hdf5Writer out(folder / (by_rows ? "rows.h5" : "array.h5"));
        if (by_rows)
            out.write_rows<double>("a", 50000, 3, hostile_label, [&](std::size_t i, std::span<double> row) {
                std::copy_n(&values[3 * i], 3, row.begin());
            });
        else
            out.write("a", values, 3, hostile_label);
        ASSERT_TRUE(out.commit());
    }
    Result<Hdf5Reader> in = Hdf5Reader::open(folder / "rows.h5");
    ASSERT_TRUE(in) << in.error().message;
    EXPECT_EQ(in->read<double>("a", 3), values);
    EXPECT_EQ(*read_whole_file(folder / "rows.h5"), *read_whole_file(folder / "array.h5"));
}

TEST(Hdf5Writers, ReportDiskErrors) {
    if (!std::filesystem::exists("/dev/full")) return;
    Hdf5Writer out("/dev/full");
    out.write("a", std::vector<double>(100000, 1.0), 1, hostile_label);
    const Result<void> written = out.commit();
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().code, ErrorCode::cannot_write);
    EXPECT_NE(written.error().message.find("No space"), std::string::npos) << written.error().message;
    Hdf5Writer nowhere("/nowhere/at/all.h5");
    nowhere.write("a", std::vector<double>(10, 1.0), 1, hostile_label);
    EXPECT_FALSE(nowhere.commit());
}

TEST(HostileSolutions, WithOtherDataSetTypesAreErrors) {
    const TemporaryFolder folder;
    Hdf5Writer out(folder / "f.h5");
    out.write("a", std::vector<double>{1, 2, 3, 4}, 2, hostile_label);
    out.write("b", std::vector<std::int64_t>{-1, 2}, 1, hostile_label);
    out.write_text("c", "text", hostile_label);
    out.make_group("g");
    ASSERT_TRUE(out.commit());
    const auto wrong = [&](const auto& read) {
        Result<Hdf5Reader> in = Hdf5Reader::open(folder / "f.h5");
        EXPECT_TRUE(in);
        read(*in);
        return in->failed() ? in->error().message.substr(in->error().message.find("data set")) : "";
    };
    EXPECT_EQ(wrong([](auto& in) { in.template read<double>("a", 2); }), "");
    EXPECT_EQ(wrong([](auto& in) { in.template read<double>("a", 3); }), "data set a does not have rows of 3");
    EXPECT_EQ(wrong([](auto& in) { in.template read<double>("a"); }), "data set a does not have rows of 1");
    EXPECT_EQ(wrong([](auto& in) { in.template read<double>("b"); }), "data set b does not hold fractions");
    EXPECT_EQ(wrong([](auto& in) { in.template read<std::uint8_t>("a", 2); }), "data set a does not hold integers");
    EXPECT_EQ(wrong([](auto& in) { in.template read<double>("x/y"); }), "data set x/y is missing");
    EXPECT_EQ(wrong([](auto& in) { in.template read<double>("a/y"); }), "data set a/y is missing");
    EXPECT_EQ(wrong([](auto& in) { in.read_text("a"); }), "data set a is not one text of fixed length");
    EXPECT_EQ(wrong([](auto& in) { in.read_texts("c"); }), "data set c is not a row of texts of fixed length");
    EXPECT_TRUE(wrong([](auto& in) { in.template read<double>("g"); }).starts_with("data set g cannot be opened"));
}

TEST(HostileSolutions, WithMetadataThatCrashTheLibraryAreErrors) {
    // Metadata that claim that the attributes of a data set are also in a heap, at an address without one. Version
    // 1.10.8 of the library crashes on it; others may not.
    std::string bytes = fuzz::solution_corpus().at(0);
    const std::string heap = std::string("\x15\x12\0\x04\0\0", 6) + std::string(16, '\xff');
    const std::string first_attribute("\x0c\x1c\0\0\x03\0\x06\0\x08\0\x04\0\0units", 18);
    const std::size_t at = bytes.find(heap + first_attribute);
    ASSERT_NE(at, bytes.npos);
    bytes[at + 6] = '\xf0';
    fuzz::mend_solution(bytes);
    const TemporaryFolder folder;
    ASSERT_TRUE(write_file(folder / "s.h5", bytes));
    const Result<Solution> back = load_solution(folder / "s.h5");
    const std::string said = back ? "" : back.error().message;
    EXPECT_TRUE(back || said.starts_with("is damaged")) << said;
}

TEST(HostileSolutions, WithMetadataThatRequestMuchMemoryAreErrors) {
    // A header that claims a second part of 32 TiB, for which version 1.10.8 of the library allocates memory.
    const std::string bytes = fuzz::solution_corpus().at(0), goes_on("\x10\x10\0\0", 4);
    const TemporaryFolder folder;
    std::size_t refused = 0;
    for (std::size_t at = bytes.find(goes_on); at != bytes.npos && at < 20000; at = bytes.find(goes_on, at + 4)) {
        std::string longer = bytes;
        longer[at + goes_on.size() + 1 + 8 + 5] = '\x20';  // the length field, which follows flags and address
        fuzz::mend_solution(longer);
        ASSERT_TRUE(write_file(folder / "s.h5", longer));
        const Result<Solution> back = load_solution(folder / "s.h5");
        refused += !back && back.error().message.starts_with("is damaged: the HDF5 library ");
    }
    EXPECT_GE(refused, 1u);
}

TEST(Exports, ByUnknownEndingsAreErrors) {
    const Result<void> written = export_solution(sample_solution(), "solution.stl");
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().code, ErrorCode::usage);
    EXPECT_EQ(written.error().hint, "known endings: .vtkhdf, .hdf, .vtu, .glb, .obj, .csv, .curves.csv");
    EXPECT_EQ(export_solution(sample_solution(), "no/folder/s.glb").error().code, ErrorCode::cannot_write);
}

}  // namespace
}  // namespace exitance
