
#include "simulation/plausible_ranges.hpp"

#include "base/check.hpp"
#include "io/scene/joint_parameters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

namespace gcpdda {

namespace {

constexpr double earth_gravity = 9.81;
constexpr double degrees_per_radian = 180.0 / std::numbers::pi;

// Shared by several rows.
const std::vector<UnitSlip> of_density{
    {1e3 / earth_gravity, "kN/m3"}, {1e3, "t/m3"}, {1.0 / earth_gravity, "N/m3"}, {1e-3, "g/m3"}};
const std::vector<UnitSlip> of_force{{1e3, "kN"}, {1e6, "MN"}};
const std::vector<UnitSlip> of_force_per_length{{1e3, "kN/m"}, {1e6, "MN/m"}};

constexpr std::string_view liner_sources = "ACI 506R (2016); Barrett & McCreath (1995)";
constexpr std::string_view bolt_sources = "Stillborg (1994); Hoek, Kaiser & Bawden (1995)";

// Bounds are rounded outwards from what the sources have: what lies beyond is another unit, not another rock.
// clang-format off
const std::vector<PlausibleRange> ranges_before_joints{
  {"run.gravity", "m/s2", 0.1, 2000, earth_gravity, {{1e-3, "mm/s2"}, {1e3, "km/s2"}}, "planets and geotechnical centrifuges have", "Taylor (1995): centrifuges up to 200 times 9.81 m/s2"},
  {"run.rayleigh.ratio", "", 1e-4, 1, 0.05, of_share, "rock and joints lose", "Kramer (1996) chapter 6"},
  {"run.contact_damping", "", 1e-4, 2, 0.05, of_share, "dashpots have", "Kramer (1996) chapter 6"},
  {"material.*.density", "kg/m3", 300, 12000, 2500, of_density, "timber, soil, masonry, concrete, rock, ore, steel and lead have", "EN 1991-1-1 annex A: softwood 350, concrete 2,400, granite 2,700 to 3,000, steel 7,850, lead 11,400"},
  {"material.*.youngs_modulus", "Pa", 5e5, 5e11, 2e10, {{1e9, "GPa"}, {1e6, "MPa"}}, "soil, masonry, concrete, rock and steel have", "Bowles (1996) table 2-8: very soft clay 2 MPa; EN 1992-1-1 table 3.1: concrete 27 to 44 GPa; EN 1993-1-1: steel 210 GPa; Lama & Vutukuri (1978)"},
};
const std::vector<PlausibleRange> ranges_after_joints{
  {"block.*.size", "m", 1e-3, 500, 1, of_length, "the roots of the areas of blocks are", "grains of sand to blocks of a mountain"},
  {"block.*.velocity", "m/s", 1e-9, 300, 5, {{1e-3, "mm/s"}, {1e-2, "cm/s"}}, "falling and blasted rock has", "Wyllie & Mah (2004) chapter 12: rock fall"},
  {"block.*.spin", "rad/s", 1e-9, 200, 3, {{1.0 / degrees_per_radian, "degrees/s"}}, "falling rock spins at", "Wyllie & Mah (2004) chapter 12: rock fall"},
  {"wall.*.block_size", "m", 1e-3, 200, 0.5, of_length, "bricks and blocks have", "grains of sand to blocks of a mountain"},
  {"pyramid.*.block_size", "m", 1e-3, 200, 0.5, of_length, "bricks and blocks have", "grains of sand to blocks of a mountain"},
  {"region.size", "m", 0.02, 1e4, 50, of_length, "the root of the area of a sample or a mountain side is", "a shear box to a mountain side"},
  {"joint_set.*.spacing", "m", 1e-3, 500, 2, of_length, "joints have", "ISRM (1978): extremely close below 0.02 m, extremely wide above 6 m"},
  {"joint_set.*.p21", "m/m2", 0.002, 1000, 1, {}, "joint sets have", "ISRM (1978): the inverse of the spacing"},
  {"joint_set.*.trace_length", "m", 0.01, 5000, 10, of_length, "joints have", "ISRM (1978): persistence from below 1 m to above 20 m"},
  {"joint_set.*.gap", "m", 1e-3, 5000, 5, of_length, "rock bridges have", "ISRM (1978)"},
  {"opening.*.size", "m", 0.02, 300, 10, of_length, "boreholes to caverns have widths of", "Hoek & Brown (1980)"},
  {"voronoi.*.size", "m", 1e-4, 200, 1, of_length, "grains and blocks have", "grains of sand to blocks of a mountain"},
  {"bricks.*.block_size", "m", 1e-3, 200, 0.5, of_length, "bricks and blocks have", "grains of sand to blocks of a mountain"},
  {"water.*.density", "kg/m3", 800, 2000, 1000, of_density, "fresh water, brine and slurry have", "fresh water 1,000, sea water 1,025, saturated brine 1,200; EN 1538: bentonite slurry"},
  {"in_situ.stress", "Pa", 5e3, 1e9, 5e6, of_stress, "a load on the surface to the rock of the deepest mines has", "EN 1991-1-1 table 6.2: crowds 5 kPa; Brown & Hoek (1978): 27 kPa for each metre of depth"},
  {"in_situ.k0", "", 0.05, 15, 1, of_share, "measurements have", "Brown & Hoek (1978): 0.3 + 100/depth to 0.5 + 1500/depth"},
  {"in_situ.density", "kg/m3", 300, 12000, 2500, of_density, "soil, concrete, rock and ore have", "EN 1991-1-1 annex A"},
  {"earthquake.record.acceleration", "m/s2", 1, 20, 3, {{1e-2, "cm/s2"}, {1e-3, "mm/s2"}, {earth_gravity, "g"}}, "records of strong shaking have peaks of", "Strasser & Bommer (2009): few records exceed 2 g"},
  {"earthquake.record.velocity", "m/s", 0, 3, 0.3, {{1e-2, "cm/s"}, {1e-3, "mm/s"}}, "records of strong shaking have peaks of", "Strasser & Bommer (2009): about 3 m/s at most"},
  {"earthquake.p_wave_speed", "m/s", 100, 1e4, 3000, {{1e3, "km/s"}}, "soil to fresh rock has", "Lama & Vutukuri (1978); Kramer (1996)"},
  {"earthquake.s_wave_speed", "m/s", 30, 7000, 1500, {{1e3, "km/s"}}, "soil to fresh rock has", "Lama & Vutukuri (1978); Kramer (1996)"},
  {"support.*.axial_stiffness", "N/m", 1e5, 1e11, 5e7, of_force_per_length, "bolts and cables have", bolt_sources},
  {"support.*.axial_rigidity", "N", 1e6, 1e11, 1e8, of_force, "bolts and cables have", "210 GPa times 5 mm2 to 0.5 m2 of steel"},
  {"support.*.axial_yield", "N", 5e3, 1e8, 2e5, of_force, "bolts and cables have", bolt_sources},
  {"support.*.shear_stiffness", "N/m", 1e4, 1e11, 2e7, of_force_per_length, "grouted bolts have", bolt_sources},
  {"support.*.shear_yield", "N", 2e3, 1e8, 1e5, of_force, "grouted bolts have", bolt_sources},
  {"support.*.rupture_strain", "", 1e-3, 0.6, 0.1, of_share, "steel and glass fibre have", "EN 10138: 0.035 for strand; Stillborg (1994)"},
  {"support.*.pretension", "N", 1e3, 1e8, 1e5, of_force, "bolts and cables have", bolt_sources},
  {"support.*.active_length", "m", 0.01, 5, 0.3, of_length, "about 20 diameters of a bolt are", bolt_sources},
  {"support.*.bond_strength", "N/m", 5e3, 1e7, 3e5, of_force_per_length, "grout has", bolt_sources},
  {"support.*.spacing", "m", 0.1, 20, 1.5, of_length, "bolts have distances of", bolt_sources},
  {"support.*.thickness", "m", 0.003, 3, 0.1, of_length, "sprayed membranes to cast linings have thicknesses of", liner_sources},
  {"support.*.youngs_modulus", "Pa", 1e8, 2.5e11, 2e10, {{1e9, "GPa"}, {1e6, "MPa"}}, "fresh shotcrete to steel has", "ACI 506R (2016): shotcrete 17 to 40 GPa; EN 1993-1-1: steel 210 GPa"},
  {"support.*.compressive_strength", "Pa", 5e5, 5e8, 3e7, of_stress, "fresh shotcrete to steel has", liner_sources},
  {"support.*.tensile_strength", "Pa", 1e5, 5e8, 2e6, of_stress, "fresh shotcrete to steel has", liner_sources},
  {"support.*.residual_tensile_strength", "Pa", 1e4, 5e8, 1e6, of_stress, "fibres and meshes bear", liner_sources},
  {"support.*.shear_strength", "Pa", 1e5, 5e8, 2e6, of_stress, "fresh shotcrete to steel has", liner_sources},
  {"support.*.adhesion", "Pa", 1e4, 5e6, 5e5, of_stress, "shotcrete on rock has", "Barrett & McCreath (1995): 0 to 1.5 MPa"},
  {"support.*.bond_width", "m", 0.003, 1, 0.03, of_length, "bonds act over", "Barrett & McCreath (1995): about 30 mm"},
  {"bolt.*.length", "m", 0.1, 300, 4, of_length, "bolts and cables have", bolt_sources},
};
// clang-format on

std::string words_on_range(const PlausibleRange &row) {
  return fmt::format("{:g} to {:g}{}{}", row.low, row.high, row.unit.empty() ? "" : " ", row.unit);
}

constexpr std::string_view page_head = R"(# Plausible values

A wrong unit rarely stops a run: it runs, and means nothing. So every run and `gcpdda inspect` begin with a warning for each
value that neither rock, soil, concrete, steel nor masonry has, with what was probably meant; warnings never stop a run.
`gcpdda reference --values` prints this page from the table that judges.

| key | range | probably meant, if it fits | from |
|---|---|---|---|
)";

constexpr std::string_view page_tail = R"(
Zero means "none" and is always plausible. Values that a scene leaves to their defaults are not judged. A scene in
normalised units has no unit slips: where gravity has the size 1, or all densities are 1, only angles and ratios are judged.
`size` is the root of the area: of the median mobile block, of the region; of an opening it is its width. `velocity` and
`spin` are those of `velocity`, `prescribed_velocity` and `velocity_table`; `gravity` is its size; `stress` is the larger of
the principal values of [in_situ] at the level. `record` is the peak of the record times `scale`; the lower bound of
accelerations is judged where the scene does not give `scale`.

Besides these values the following is warned of, each kind in one line with the number of places:

| what | why |
|---|---|
| gravity points upwards | y is up |
| an interval of output, history or checkpoints, a ramp or the start of an earthquake beyond the end of the run | it never comes |
| faults, maps, openings or layers that lie outside the region | they cut nothing |
| a fault or a trace of a map that ends short of another line by less than 1/1000 of its length | it ends in the rock and cuts nothing there |
| a joint law or material that nothing uses; the nearest name is suggested | `--set joint.defualt.cohesion=0` makes a new law; a law that neither has `materials` nor is named by `edge_joints` is an error where the scene has neither a region nor a block file, because nothing can use it |
| gravity acts and nothing is fixed, held or driven; no block can move | everything falls; nothing happens |
| contacts at rest overlap by more than 1 % of the median block | blocks sink into each other; names the stiffness that would do |
| coordinates so large that their rounding disturbs what a stage waits for, or the overlap by which the smallest block rests | the stage never settles; names a round offset to subtract from all coordinates |
| parallel edges face each other across less than 5 % of a block, and more than rounding | drawn as touching, they do not touch |
| a monitor follows a block that a stage excavates | its history ends there |
| blocks cut from a region with a mean width below 1/1000 of the median side (the root of the area) of the blocks: traces that nearly coincide, or nearly cross in one point | joints that close by an ordinary amount close through them; names the `min_width` that makes them parts of their neighbours |
| blocks thinner than 1/20 of the median width under in-situ stress, and those that it presses together by more than 5 % of their width, which is refused | names the `min_width` that merges them; by default it is 1/20 of the smallest mean spacing with [in_situ] |
| a load below 1/1000 of the weight of its block | N/m are meant, not kN/m |
| a record of velocities, without `quantity` in the scene, whose acceleration exceeds its range while its values are those of accelerations | accelerations are read as velocities |
| a record that plays in a settle stage | the damping of the stage takes the motion that the record causes |
| a record that is longer than what is left of the stages of kind `run`, or of the run | the rest of the record plays in a settle stage or not at all |

## Sources

- ACI 506R (2016): Guide to Shotcrete, American Concrete Institute.
- Bandis, S. C., Lumsden, A. C., Barton, N. R. (1983): Fundamentals of rock joint deformation. Int. J. Rock Mech. Min. Sci. 20, 249-268.
- Barrett, S. V. L., McCreath, D. R. (1995): Shotcrete support design in blocky ground: towards a deterministic approach. Tunn. Undergr. Space Technol. 10, 79-89.
- Barton, N., Choubey, V. (1977): The shear strength of rock joints in theory and practice. Rock Mech. 10, 1-54.
- Bowles, J. E. (1996): Foundation Analysis and Design, 5th ed., McGraw-Hill.
- Brown, E. T., Hoek, E. (1978): Trends in relationships between measured in-situ stresses and depth. Int. J. Rock Mech. Min. Sci. 15, 211-215.
- Deere, D. U., Miller, R. P. (1966): Engineering Classification and Index Properties for Intact Rock, AFWL-TR-65-116.
- EN 1538 (slurry walls), EN 1991-1-1 (Eurocode 1, densities and loads), EN 1992-1-1 (Eurocode 2, concrete), EN 1993-1-1 (Eurocode 3, steel), EN 10138 (prestressing steel).
- Hoek, E., Bray, J. W. (1981): Rock Slope Engineering, 3rd ed., Institution of Mining and Metallurgy.
- Hoek, E., Brown, E. T. (1980): Underground Excavations in Rock, Institution of Mining and Metallurgy.
- Hoek, E., Diederichs, M. S. (2006): Empirical estimation of rock mass modulus. Int. J. Rock Mech. Min. Sci. 43, 203-215.
- Hoek, E., Kaiser, P. K., Bawden, W. F. (1995): Support of Underground Excavations in Hard Rock, Balkema.
- ISRM (1978): Suggested methods for the quantitative description of discontinuities in rock masses. Int. J. Rock Mech. Min. Sci. 15, 319-368.
- Kramer, S. L. (1996): Geotechnical Earthquake Engineering, Prentice Hall.
- Lama, R. D., Vutukuri, V. S. (1978): Handbook on Mechanical Properties of Rocks, Trans Tech.
- Stillborg, B. (1994): Professional Users Handbook for Rock Bolting, 2nd ed., Trans Tech.
- Strasser, F. O., Bommer, J. J. (2009): Strong ground motions - have we seen the worst? Bull. Seism. Soc. Am. 99, 2613-2637.
- Taylor, R. N. (1995): Geotechnical Centrifuge Technology, Blackie.
- Wyllie, D. C., Mah, C. W. (2004): Rock Slope Engineering, 4th ed., Spon.
)";

} // namespace

std::span<const PlausibleRange> plausible_ranges() {
  static const std::vector<PlausibleRange> ranges = [] {
    std::vector<PlausibleRange> all = ranges_before_joints;
    for (const scene_text::JointParameter &parameter : scene_text::joint_parameters()) {
      if (parameter.value != nullptr) {
        all.push_back(parameter.plausible);
        all.back().key = parameter.key.path;
      }
    }
    all.insert(all.end(), ranges_after_joints.begin(), ranges_after_joints.end());
    return all;
  }();
  return ranges;
}

const PlausibleRange &plausible_range(std::string_view key) {
  const std::span<const PlausibleRange> ranges = plausible_ranges();
  const auto found =
      std::find_if(ranges.begin(), ranges.end(), [&](const auto &row) { return row.key == key; });
  expect(found != ranges.end(), "plausibility: a key has a range");
  return *found;
}

std::string plausible_values_page() {
  std::string page(page_head);
  for (const PlausibleRange &row : plausible_ranges()) {
    std::string slips;
    for (const UnitSlip &slip : row.slips) {
      slips += fmt::format("{}{}", slips.empty() ? "" : ", ", slip.unit);
    }
    page += fmt::format("| `{}` | {} | {} | {} |\n", row.key, words_on_range(row), slips, row.source);
  }
  return page + std::string(page_tail);
}

} // namespace gcpdda
