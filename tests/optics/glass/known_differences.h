// SPDX-License-Identifier: Apache-2.0
// Glasses whose bundled index differs at a catalogue line from that of an available AGF file, with an upper limit of
// the difference. CDGM: the bundled figures are those of its catalogue of 2022, refitted; cdgm.agf is an earlier
// edition, with Schott's formula and coefficients of fewer digits (for H-LAF4, two editions differ by 1e-3 in the
// ultraviolet). HOYA: its glasses M-TAF1 and MC-TAF1 were remade and E-FL6 refitted between hoya.agf and the catalogue
// of 2017. SUMITA K-GIR79: n_d 1.85920 in sumita.agf, 1.85588 in the catalogue of 2017.
#pragma once

namespace contrejour::test {

struct KnownDifference {
  const char* maker;
  const char* name;
  double max;  // as printed, to two digits
};

// clang-format off
inline constexpr KnownDifference kKnownDifferences[] = {
    {"CDGM", "D-LAF79", 2.0e-04}, {"CDGM", "D-LAK6", 1.9e-05}, {"CDGM", "D-LAK70", 5.2e-06},
    {"CDGM", "D-ZF10", 9.5e-06}, {"CDGM", "D-ZK2", 4.8e-05}, {"CDGM", "D-ZK3", 2.9e-05}, {"CDGM", "D-ZK3L", 3.5e-05},
    {"CDGM", "D-ZLAF52LA", 7.9e-05}, {"CDGM", "F13", 5.0e-05}, {"CDGM", "F4", 8.8e-05}, {"CDGM", "F5", 4.2e-05},
    {"CDGM", "F6", 1.8e-04}, {"CDGM", "F7", 2.4e-04}, {"CDGM", "H-BAK1", 1.9e-05}, {"CDGM", "H-BAK2", 6.4e-06},
    {"CDGM", "H-BAK3", 2.0e-05}, {"CDGM", "H-BAK4", 3.1e-05}, {"CDGM", "H-BAK5", 3.8e-05},
    {"CDGM", "H-BAK6", 2.8e-04}, {"CDGM", "H-BAK7", 2.4e-05}, {"CDGM", "H-BAK8", 2.2e-05}, {"CDGM", "H-F1", 3.3e-05},
    {"CDGM", "H-F13", 2.2e-04}, {"CDGM", "H-F2", 2.4e-05}, {"CDGM", "H-F4", 2.2e-04}, {"CDGM", "H-F51", 2.2e-04},
    {"CDGM", "H-FK61", 4.1e-05}, {"CDGM", "H-K10", 7.3e-05}, {"CDGM", "H-K11", 2.8e-05}, {"CDGM", "H-K50", 6.2e-05},
    {"CDGM", "H-K51", 2.1e-05}, {"CDGM", "H-K6", 3.8e-06}, {"CDGM", "H-K7", 4.9e-05}, {"CDGM", "H-K9L", 3.0e-05},
    {"CDGM", "H-KF6", 3.9e-05}, {"CDGM", "H-LAF2", 6.4e-05}, {"CDGM", "H-LAF4", 1.3e-03},
    {"CDGM", "H-LAF52", 2.3e-05}, {"CDGM", "H-LAF53", 8.3e-05}, {"CDGM", "H-LAF62", 2.0e-04},
    {"CDGM", "H-LAF6LA", 1.2e-04}, {"CDGM", "H-LAF7", 1.3e-04}, {"CDGM", "H-LAFL5", 2.6e-05},
    {"CDGM", "H-LAK10", 1.2e-05}, {"CDGM", "H-LAK11", 5.9e-05}, {"CDGM", "H-LAK12", 1.4e-04},
    {"CDGM", "H-LAK3", 2.0e-04}, {"CDGM", "H-LAK4L", 5.0e-05}, {"CDGM", "H-LAK50A", 7.0e-05},
    {"CDGM", "H-LAK52", 2.3e-05}, {"CDGM", "H-LAK53A", 3.7e-05}, {"CDGM", "H-LAK54", 7.7e-05},
    {"CDGM", "H-LAK5A", 3.7e-05}, {"CDGM", "H-LAK6A", 6.8e-05}, {"CDGM", "H-LAK8A", 1.4e-04},
    {"CDGM", "H-QF1", 2.2e-04}, {"CDGM", "H-QF14", 1.7e-05}, {"CDGM", "H-QF3", 9.5e-05}, {"CDGM", "H-QF50", 6.6e-05},
    {"CDGM", "H-QF56", 1.8e-04}, {"CDGM", "H-QF8", 1.5e-04}, {"CDGM", "H-QK1", 1.1e-05}, {"CDGM", "H-QK3L", 6.8e-06},
    {"CDGM", "H-ZBAF1", 7.4e-05}, {"CDGM", "H-ZBAF16", 3.2e-05}, {"CDGM", "H-ZBAF20", 1.3e-04},
    {"CDGM", "H-ZBAF21", 2.5e-05}, {"CDGM", "H-ZBAF3", 1.6e-04}, {"CDGM", "H-ZBAF5", 1.2e-04},
    {"CDGM", "H-ZBAF50", 9.6e-05}, {"CDGM", "H-ZBAF52", 1.7e-04}, {"CDGM", "H-ZF1", 1.9e-05},
    {"CDGM", "H-ZF10", 5.8e-05}, {"CDGM", "H-ZF11", 1.9e-04}, {"CDGM", "H-ZF12", 5.4e-05},
    {"CDGM", "H-ZF13", 1.9e-05}, {"CDGM", "H-ZF2", 3.6e-05}, {"CDGM", "H-ZF3", 3.4e-04}, {"CDGM", "H-ZF5", 2.2e-04},
    {"CDGM", "H-ZF50", 2.4e-04}, {"CDGM", "H-ZF52A", 9.3e-06}, {"CDGM", "H-ZF6", 8.7e-05},
    {"CDGM", "H-ZF7LA", 1.8e-04}, {"CDGM", "H-ZK1", 2.1e-05}, {"CDGM", "H-ZK10", 1.0e-04},
    {"CDGM", "H-ZK10L", 2.1e-05}, {"CDGM", "H-ZK11", 2.9e-05}, {"CDGM", "H-ZK14", 9.4e-05},
    {"CDGM", "H-ZK2", 1.1e-05}, {"CDGM", "H-ZK20", 2.6e-05}, {"CDGM", "H-ZK21", 7.9e-05}, {"CDGM", "H-ZK3", 9.3e-06},
    {"CDGM", "H-ZK4", 2.6e-05}, {"CDGM", "H-ZK5", 3.4e-05}, {"CDGM", "H-ZK50", 1.1e-05}, {"CDGM", "H-ZK6", 4.0e-05},
    {"CDGM", "H-ZK8", 6.6e-05}, {"CDGM", "H-ZLAF51", 3.1e-04}, {"CDGM", "H-ZLAF66", 9.7e-05},
    {"CDGM", "H-ZLAF76", 1.1e-04}, {"CDGM", "K4A", 7.5e-05}, {"CDGM", "QF50", 2.7e-05}, {"CDGM", "TF3", 3.0e-04},
    {"CDGM", "ZF2", 1.6e-04}, {"HOYA", "E-FL6", 2.9e-05}, {"HOYA", "M-TAF1", 5.6e-03}, {"HOYA", "MC-TAF1", 5.6e-03},
    {"SUMITA", "K-GIR79", 3.6e-03},
};
// clang-format on

}  // namespace contrejour::test
