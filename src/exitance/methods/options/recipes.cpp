#include "exitance/methods/options/recipes.hpp"

#include <algorithm>
#include <sstream>

#include "exitance/base/nearest.hpp"

namespace exitance {
namespace {

// clang-format off
constexpr Recipe table[] = {
    {"classical-matrix", "matrix without final gather or error estimate", "Goral84",
     "--method matrix --certify off --output-light elements"},
    {"classical-progressive", "progressive refinement without final gather or error estimate", "Cohen88",
     "--method progressive --certify off --output-light elements"},
    {"classical-substructuring", "substructuring without final gather or error estimate", "Cohen86",
     "--method substructuring --certify off --output-light elements"},
    {"classical-hierarchical", "hierarchical radiosity without final gather or error estimate", "Hanrahan91",
     "--method hierarchical --certify off --output-light elements"},
    {"classical-wavelet", "wavelet radiosity without final gather or error estimate", "Gortler93",
     "--method wavelet --certify off --output-light elements"},
    {"classical-monte-carlo", "stochastic Jacobi iteration, delivered by its elements", "Neumann95",
     "--method monte-carlo --output-light elements"},
    {"classical-growing-cells", "growing cells with all light in the networks, delivered by their Gaussians", "",
     "--method growing-cells --gcs classic --output-light elements"},
    {"classical-discontinuity", "links on trees that are cut along critical lines; light of the leaves", "Lischinski93",
     "--method discontinuity --local-pass a"},
    {"goral84", "full matrix of analytic form factors on uniform elements", "Goral84",
     "--method matrix --form-factors analytic --direct carried --mesh uniform --output-light elements"},
    {"cohen85", "full matrix of hemicube form factors, solved by Gauss-Seidel", "Cohen85",
     "--method matrix --form-factors hemicube --relaxation gauss-seidel --direct carried --mesh uniform "
     "--output-light elements"},
    {"cohen86-substructuring", "patches that shoot to finer elements", "Cohen86",
     "--method substructuring --direct carried --mesh uniform --output-light elements"},
    {"cohen88-progressive", "shooting by hemicubes, with the ambient term", "Cohen88",
     "--method progressive --form-factors hemicube --ambient --direct carried --mesh uniform --output-light elements"},
    {"wallace89", "shooting to vertices by rays", "Wallace89",
     "--method progressive --form-factors vertex --direct carried --mesh uniform --output-light elements"},
    {"hanrahan91", "links refined by power (BF) in four rounds of multigrid", "Hanrahan91",
     "--method hierarchical --oracle bf --threshold 0.1 --multigrid 4 --kernel disc --direct carried "
     "--output-light elements"},
    {"feda92", "shooting with overshooting", "Feda92",
     "--method progressive --overshooting --direct carried --mesh uniform --output-light elements"},
    {"gatenby95-a", "discontinuity meshing, local pass a: light of the leaves", "Gatenby95",
     "--method discontinuity --local-pass a"},
    {"gatenby95-b", "discontinuity meshing, local pass b: new form factors", "Gatenby95",
     "--method discontinuity --local-pass b"},
    {"gatenby95-c", "discontinuity meshing, local pass c: new form factors and visibility", "Gatenby95",
     "--method discontinuity --local-pass c"},
    {"gatenby95-d", "discontinuity meshing, local pass d: primary sources recomputed", "Gatenby95",
     "--method discontinuity --local-pass d"},
    {"gatenby95-e", "discontinuity meshing, local pass e: exact direct light", "Gatenby95",
     "--method discontinuity --local-pass e"},
    {"vinod95-tasks", "hierarchical radiosity as tasks that create tasks", "Vinod95",
     "--method hierarchical --task-engine --oracle bf"},
    {"willmott97-haar", "wavelet radiosity with the Haar basis", "Willmott97",
     "--method wavelet --basis haar --oracle bf --threshold 0.1 --direct carried --output-light elements"},
    {"willmott97-flatlet2", "wavelet radiosity with flatlets of order 2", "Willmott97",
     "--method wavelet --basis flatlet2 --oracle bf --threshold 0.1 --direct carried --output-light elements"},
    {"willmott97-flatlet3", "wavelet radiosity with flatlets of order 3", "Willmott97",
     "--method wavelet --basis flatlet3 --oracle bf --threshold 0.1 --direct carried --output-light elements"},
    {"willmott97-multiwavelet2", "wavelet radiosity with multiwavelets of order 2", "Willmott97",
     "--method wavelet --basis multiwavelet2 --oracle bf --threshold 0.1 --direct carried --output-light elements"},
    {"willmott97-multiwavelet3", "wavelet radiosity with multiwavelets of order 3", "Willmott97",
     "--method wavelet --basis multiwavelet3 --oracle bf --threshold 0.1 --direct carried --output-light elements"},
    {"bohn02", "growing cells as published, at most 64 units", "",
     "--method growing-cells --gcs classic --max-units 64 --output-light elements"},
};
// clang-format on

}  // namespace

std::span<const Recipe> recipes() {
    return table;
}

const Recipe* find_recipe(std::string_view name) {
    const auto* const found =
        std::find_if(std::begin(table), std::end(table), [&](const Recipe& r) { return r.name == name; });
    return found == std::end(table) ? nullptr : found;
}

std::string nearest_recipe(std::string_view name) {
    std::vector<std::string> names;
    for (const Recipe& recipe : table) names.emplace_back(recipe.name);
    return nearest(name, names);
}

std::vector<std::string> preset_words(const Recipe& recipe) {
    std::istringstream in{std::string(recipe.presets)};
    std::vector<std::string> words;
    for (std::string word; in >> word;) words.push_back(word);
    return words;
}

}  // namespace exitance
