// SPDX-License-Identifier: Apache-2.0
// Householder's reflections of columns in packets (Highway): the part of a factorisation by QR that takes the time.
// A ridge adds to the rows of a matrix one row for each column, of which that column alone is not 0. The reflection of
// a column therefore consists of a 1 in the column's own row and of `rows` numbers below, and leaves all other rows of
// the ridge as they are: these need not be stored. Block reflections: Schreiber and Van Loan 1989, "A storage-efficient
// WY representation for products of Householder transformations".
#pragma once

#include <array>
#include <cstddef>

namespace contrejour::inline internal::polynomial {

inline constexpr std::size_t kPanelColumns = 16;  // at most, of a panel
inline constexpr std::size_t kRowsMultiple = 8;  // columns are padded with zeros to a multiple of this

// The reflections of some columns, one after the other: I - V T V^T for their product.
struct Panel {
  std::size_t first = 0, count = 0;  // columns of the matrix
  std::array<std::array<double, kPanelColumns>, kPanelColumns> t{};  // upper triangle
};

// Replaces a panel's columns, column-major and one after the other, by the reflections' vectors, and writes the panel's
// own part of the triangle R, r[j][k] in row j and column k.
void factor_panel(double* columns, std::size_t rows, double ridge, Panel& panel,
                  std::array<std::array<double, kPanelColumns>, kPanelColumns>& r);

// Applies a panel's reflections to other columns, and writes for each of them the panel's rows, kPanelColumns apart.
void reflect(const Panel& panel, const double* vectors, std::size_t rows, double* columns, std::size_t count,
             double* panel_rows);

}  // namespace contrejour::inline internal::polynomial
