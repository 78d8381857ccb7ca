#pragma once

#include <array>
#include <cstddef>

namespace exitance {

/// One row of a two-scale relation in one dimension: a function on the coarse interval as a sum of the functions on its
/// left and right half.
template <std::size_t M>
struct TwoScaleRow {
    std::array<double, M> left, right;
};

/// Two-scale relations of M functions per interval: the coarse functions (`smooth`) and the wavelets that complete them
/// (`detail`), each with vanishing moments. Source: [Alpert93], [Gortler93].
template <std::size_t M>
struct TwoScale {
    std::array<TwoScaleRow<M>, M> smooth, detail;
};

namespace two_scale {

inline constexpr double root2 = 1.4142135623730950488, root3 = 1.7320508075688772935, root5 = 2.2360679774997896964,
                        root15 = 3.8729833462074168852;
/// The rows below are for orthonormal Legendre polynomials on [0, 1] and orthonormal ones on its halves; they are
/// divided by this factor.
inline constexpr double scale = 2 * root2;

inline constexpr TwoScale<1> haar = {{{{{{2 / scale}}, {{2 / scale}}}}}, {{{{{-2 / scale}}, {{2 / scale}}}}}};

inline constexpr TwoScale<2> multiwavelet2 = {
    {{{{{2 / scale, 0}}, {{2 / scale, 0}}}, {{{-root3 / scale, 1 / scale}}, {{root3 / scale, 1 / scale}}}}},
    {{{{{0, -2 / scale}}, {{0, 2 / scale}}},                             // the details have 2 vanishing moments
      {{{1 / scale, root3 / scale}}, {{-1 / scale, root3 / scale}}}}}};  // 3

inline constexpr TwoScale<3> multiwavelet3 = {
    {{{{{2 / scale, 0, 0}}, {{2 / scale, 0, 0}}},
      {{{-root3 / scale, 1 / scale, 0}}, {{root3 / scale, 1 / scale, 0}}},
      {{{0, -root15 / 2 / scale, 0.5 / scale}}, {{0, root15 / 2 / scale, 0.5 / scale}}}}},
    {{{{{-2 / 3.0 / scale, -2 / root3 / scale, 2 * root5 / 3 / scale}},
       {{2 / 3.0 / scale, -2 / root3 / scale, -2 * root5 / 3 / scale}}},  // the details have 3 vanishing moments
      {{{0, -0.5 / scale, -root15 / 2 / scale}}, {{0, 0.5 / scale, -root15 / 2 / scale}}},  // 4
      {{{-root5 / 3 / scale, -root15 / 3 / scale, -4 / 3.0 / scale}},
       {{root5 / 3 / scale, -root15 / 3 / scale, 4 / 3.0 / scale}}}}}};  // 5

/// Flatlets are box functions, not orthogonal to their details. The rows act on the means over 2 M equal cells:
/// `smooth` averages pairs of cells, and details vanish on polynomials of degree below M.
inline constexpr TwoScale<2> flatlet2 = {{{{{{0.5, 0.5}}, {{0, 0}}}, {{{0, 0}}, {{0.5, 0.5}}}}},
                                         {{{{{-1, 3}}, {{-3, 1}}}, {{{1, -1}}, {{-1, 1}}}}}};
inline constexpr TwoScale<3> flatlet3 = {
    {{{{{0.5, 0.5, 0}}, {{0, 0, 0}}}, {{{0, 0, 0.5}}, {{0.5, 0, 0}}}, {{{0, 0, 0}}, {{0, 0.5, 0.5}}}}},
    {{{{{-5, 7, 4}}, {{-4, -7, 5}}}, {{{1, -3, 2}}, {{2, -3, 1}}}, {{{-1, 5, -10}}, {{10, -5, 1}}}}}};

/// Means over the 2 M cells from the means over M boxes if all details are zero; one row per cell, from the left. Exact
/// for polynomials of degree below M.
inline constexpr std::array<std::array<double, 2>, 4> flatlet2_synthesis = {
    {{1.25, -0.25}, {0.75, 0.25}, {0.25, 0.75}, {-0.25, 1.25}}};
inline constexpr std::array<std::array<double, 3>, 6> flatlet3_synthesis = {{{11.0 / 8, -1.0 / 2, 1.0 / 8},
                                                                             {5.0 / 8, 1.0 / 2, -1.0 / 8},
                                                                             {1.0 / 8, 1.0, -1.0 / 8},
                                                                             {-1.0 / 8, 1.0, 1.0 / 8},
                                                                             {-1.0 / 8, 1.0 / 2, 5.0 / 8},
                                                                             {1.0 / 8, -1.0 / 2, 11.0 / 8}}};

}  // namespace two_scale
}  // namespace exitance
