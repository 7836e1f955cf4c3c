#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "geometry/crack_surface.hpp"
#include "geometry/random_places.hpp"
#include "geometry/shape.hpp"
#include "geometry/turned_shape.hpp"
#include "input/expression.hpp"
#include "input/point_list.hpp"

namespace riven {

/// What the user wrote, parsed and checked, in SI units. `src/input/case_format.cpp` declares the format.

struct TableInput {  // [table.NAME]: a function that formulas may call
  std::string name;
  std::string file;               // CSV, relative to the case file
  std::string argument, value;    // its columns
  std::string outside = "error";  // beyond the ends: "error", or "hold" the first and the last value
  std::shared_ptr<const TableFunction> function;  // what the file holds
  Location at;
};

struct FieldInput {  // [field.NAME]: values at places that formulas may read
  std::string name;
  std::string file;                            // CSV, relative to the case file
  std::string value;                           // its column
  std::shared_ptr<const FieldFunction> field;  // what the file holds
  Location at;
};

struct PointsInput {               // [geometry] points = {...}, or mesh = {...}
  std::string file;                // CSV or MSH, relative to the case file
  std::string unit;                // of a mesh's coordinates; empty for points
  std::vector<double> size, from;  // m; of the box that points fill, empty if not given
  std::shared_ptr<const PointList> list;

  [[nodiscard]] bool has_edges() const { return !size.empty(); }
  [[nodiscard]] bool is_mesh() const { return !unit.empty(); }
};

class Surface;
struct Mesh;

struct SurfaceInput {  // [geometry] surface = {...}
  std::string file;    // STL, relative to the case file
  std::string unit;    // of its coordinates
  std::shared_ptr<const Surface> surface;
};

struct ArchInput {                       // [geometry] arch = {...}
  double span = 0, rise = 0, depth = 0;  // m; of its middle line, and across it in the plane
};

struct ElementsInput {               // [geometry] with elements instead of points
  std::vector<int> along;            // their numbers along the axes of the shape
  std::optional<ArchInput> arch;     // else of the corners, else of a box
  std::vector<Point> corners;        // m; of a quadrilateral
  std::string file, unit;            // or of Gmsh's: MSH, relative to the case file, and of its coordinates
  std::shared_ptr<const Mesh> mesh;  // what the file holds
};

struct GeometryInput {   // [geometry]
  Shape shape;           // the body; a box is centred at the origin unless `from` gives its lower corner
  int dimension = 2;     // number of entries of the box's size; 2 for a disc with a thickness
  double thickness = 1;  // m (2D), or m^2 (1D: key `area`)
  double spacing = 0;    // m; of listed points the mean
  std::optional<PointsInput> points;      // instead of a lattice; the shape is the box around them
  std::optional<SurfaceInput> surface;    // what the lattice fills; the shape is the box around it
  std::optional<ElementsInput> elements;  // instead of points; the shape is the box around them
  std::string element;                    // their kind: "q4", "q8", "t3", "h8" or "t4"
  std::array<bool, 6> open_faces{};       // where the body does not end, or nobody knows: these are no edges
  std::string bonds = "lattice";          // or "listed", as those of points
  Location at;
  double horizon = 0;  // m
  Location horizon_at;
};

struct HoleInput {  // [[hole]]
  Shape shape;
  Location at;
};

struct CrackFileInput {  // [[crack]] surface = {...}
  std::string file;      // STL, relative to the case file
  std::string unit;      // of its coordinates
};

struct CrackInput {               // [[crack]]: exactly one of these forms
  std::optional<Point> from, to;  // in two dimensions: ends of a straight crack (m)
  std::vector<Point> path;        // or corners of a polyline
  std::vector<Point> polygon;     // in three dimensions: corners of a flat crack (m)
  std::optional<PennyCrack> penny;
  std::optional<CrackFileInput> file;
  std::vector<Segment> segments;                // what these are in two dimensions
  std::shared_ptr<const CrackSurface> surface;  // what they are in three
  Location at;
};

struct InclusionInput {  // [[inclusion]]: rigid and bonded to the body
  Shape shape;
  std::string motion = "free";  // "free": moves with the body around it; "fixed"
  Location at;
};

struct RandomShapesInput {  // random_discs, random_balls of a set
  RandomPlaces places;
  std::vector<Point> centers;  // what follows from them
};

struct SetInput {  // [set.NAME]: exactly one of where, group, a shape and a list of shapes
  std::string name;
  std::string group;  // of the mesh
  std::optional<Expression> where;
  std::optional<Shape> shape;
  std::vector<TurnedShape> boxes, discs, balls;
  std::optional<RandomShapesInput> random_discs, random_balls;
  Location at;
};

struct ModelInput {  // [model]
  // or "membrane-bond", "pmb", "lps", "correspondence", "finite-elements"
  std::string kind = "membrane";
  // Factor G of the stabilisation energy; 0 switches it off. membrane: 4, correspondence: 1 unless given
  std::optional<double> stabilisation;
  // membrane-bond: "published" or "zero-residual"; correspondence: "stabilised", "published" or
  // "bond-associated"
  std::string variant;
  std::string loading;                    // membrane-bond: "equibiaxial", "planar", "uniaxial", ...
  std::string surface_correction = "on";  // membrane-bond: or "off"
  // in two dimensions, but for membranes: or "strain"
  std::string plane = "stress";
  std::string dilatation;             // finite-elements: "mean" or "full"; empty: what suits the law
  std::string influence = "inverse";  // lps, correspondence: or "constant"
  Location at;
};

struct RelaxationInput {  // an entry of a material's relaxation
  double share = 0;       // of the isochoric stiffness that relaxes
  double time = 0;        // s
};

struct MaterialInput {  // [material.NAME]
  std::string name;
  std::string law;     // a name among those of material/law.hpp
  double density = 0;  // kg/m^3
  // What the law's own keys say, in SI, by key; a key that is not given has no value and an empty list.
  std::map<std::string, std::optional<double>> numbers;
  std::map<std::string, std::vector<double>> lists;
  std::optional<double> bulk_modulus;       // Pa; without, a rubber is incompressible
  std::string volumetric;                   // "quadratic" (if empty, too) or "logarithmic"
  std::vector<RelaxationInput> relaxation;  // Prony series; empty: elastic
  std::vector<Named> on;                    // sets whose points are of it; empty: all that no other one has
  std::optional<double> critical_stretch;   // elongation over length
  std::optional<double> critical_energy_release_rate;  // J/m^2
  std::optional<double> critical_damage;
  std::optional<double> critical_energy_density;  // J/m^3
  Location at;

  [[nodiscard]] std::optional<double> number(const std::string& key) const {
    const auto found = numbers.find(key);
    return found == numbers.end() ? std::nullopt : found->second;
  }
  /// Whether its bonds can break.
  [[nodiscard]] bool breaks() const {
    return critical_stretch || critical_energy_release_rate || critical_energy_density;
  }
};

struct InterfaceInput {              // [[interface]]: bonds between two materials
  std::vector<std::string> between;  // their names
  std::optional<double> critical_stretch;
  std::optional<double> critical_energy_release_rate;  // J/m^2
  Location at;
};

struct FailureInput {         // [failure]
  std::vector<Named> not_in;  // sets whose bonds never break
  double excess = 0.1;        // energy above their limit with which bonds may break before steps are halved
  Location at;
};

/// One component of a displacement: a function of x, y, z and stretch or t, or free.
struct ComponentInput {
  std::optional<Expression> value;  // nothing: "free"
};

struct LoadInput {        // [[load]]: exactly one of the five; but for the pressure, an entry per dimension
  std::vector<Named> on;  // named edges of the box or sets; of a body force: empty for the whole body
  std::vector<ComponentInput> displacement, velocity, traction, body_force;
  std::optional<Expression> pressure;  // Pa; normal to the deformed boundary, into the body
  std::optional<double> layer;         // m; of a traction, the spacing unless given
  Location at;

  [[nodiscard]] bool is_force() const { return !traction.empty() || !body_force.empty() || pressure; }
  /// The one that is given.
  [[nodiscard]] const std::vector<ComponentInput>& components() const {
    for (const auto* given : {&velocity, &traction, &body_force})
      if (!given->empty()) return *given;
    return displacement;
  }
};

struct InitialInput {                                  // [[initial]]
  std::vector<Named> on;                               // sets; empty: the whole body
  std::vector<ComponentInput> displacement, velocity;  // one per dimension, or none
  Location at;
};

struct SolverInput {  // [solver]
  // "dynamic-relaxation", "newton"; in time "verlet", "space-time" or "generalised-alpha"
  std::string method;
  // statics
  std::vector<double> stretch;  // output states, strictly monotone away from 1
  double increment = 0.1;       // largest step of the stretch
  // Free force / reaction, default 1e-5; of implicit motion residual and increment over their scales, 1e-8.
  std::optional<double> tolerance;
  int max_iterations = 20000;  // per load step; then the step is cut
  // in time
  double until = 0;  // s
  Location until_at;
  std::optional<double> step;  // s; default: from the stable step, or by the velocity's jumps
  double safety = 0.8;
  double damping = 0;                // 1/s
  std::string start = "initial";     // or "equilibrium"
  double start_tolerance = 1e-5;     // as `tolerance`, of that equilibrium
  std::string scheme = "two-field";  // of space-time; or "single-field"
  int gauss_points = 3;              // of the latter
  double step_tolerance = 1e-4;      // of space-time: energy of the jumps / energy of the motion
  double spectral_radius = 0.8;      // of generalised-alpha
  bool inertia = true;               // of space-time; without, the body is at rest at any time
  std::string control = "load";      // of newton; or "arc-length"
  int max_steps = 0;                 // of the arc; 0: none of it
  Location at;

  static const std::vector<std::string>& methods_in_time() {
    static const std::vector<std::string> all{"verlet", "space-time", "generalised-alpha"};
    return all;
  }
  [[nodiscard]] bool is_explicit() const { return method == "verlet"; }
  [[nodiscard]] bool in_time() const { return is_explicit() || is_implicit_motion(); }
  [[nodiscard]] bool is_implicit_motion() const {
    return method == "space-time" || method == "generalised-alpha";
  }
};

struct ContactInput {    // [contact]: points without a bond repel
  double distance = 0;   // m
  double stiffness = 1;  // times what follows from the bonds
  Location at;
};

struct SphereInput {
  Point center{};
  double radius = 0;  // m
};

struct PlaneInput {
  Point point{};
  std::vector<double> normal;  // out of the impactor, of any length
};

struct FlatInput {
  Point from{}, to{};  // in two dimensions: ends of the flat, the impactor to its left (m)
};

struct ImpactorInput {  // [[impactor]]: rigid, a sphere, a plane or a flat
  std::string name;
  std::optional<SphereInput> sphere;
  std::optional<PlaneInput> plane;
  std::optional<FlatInput> flat;
  std::optional<double> mass;                // kg: free; without, the velocity is prescribed
  std::vector<ComponentInput> velocity;      // one per dimension, or none: at rest
  std::vector<ComponentInput> displacement;  // or this, likewise
  std::string surface = "frictionless";      // or "sticking"
  double stiffness = 1;                      // times what follows from the bonds
  Location at;
};

/// How often a run writes a checkpoint: never if both are 0.
struct CheckpointInterval {
  double seconds = 0;  // of wall time
  int steps = 0;       // time steps, or iterations
};

struct OutputInput {                    // [output]
  std::optional<double> every;          // s (in time); statics: at each stretch
  std::optional<double> history_every;  // s (in time)
  std::vector<std::string> fields = {"displacement", "damage", "strain_energy_density", "nominal_stress"};
  CheckpointInterval checkpoint_every;
  Location at;
};

struct ProbeInput {  // [[probe]]
  std::string name;
  // "reaction", "nominal-stress", "displacement", "stretch", "strain", "largest", "overload",
  // "dissipated-energy", "impactor", or one of cracks
  std::string kind;
  std::string
      component;         // reaction, displacement: only this one of "x", "y", "z", under the probe's own name
  Named on;              // reaction, nominal-stress: an edge or a set; of cracks: a set, or nothing for all
  std::string impactor;  // impactor: its name
  std::optional<Point> position;  // displacement: a place in the undeformed body (m)
  std::optional<Point> from, to;  // stretch, strain: two places, whose deformed distance is compared
  std::string of, gives;          // largest: a column, and the one of which it gives the value there
  std::optional<double> damage;   // of cracks: share of the bonds that a point of a crack has lost
  std::optional<double> over;     // crack-speed: s
  std::optional<double> length;   // crack-angle, branches: m
  int least = 4;                  // fragments: points
  Location at;
};

/// A number with a unit of the user's choice.
struct AnyQuantity {
  double si = 0;
  std::string dimension;  // SI base units as UDUNITS prints them; "1" without unit
};

struct ExpectInput {   // [[expect]]
  std::string metric;  // or field + file
  std::optional<AnyQuantity> value;
  std::optional<AnyQuantity> absolute_tolerance;
  std::optional<AnyQuantity> min, max;
  std::optional<double> tolerance;  // relative
  std::string field;                // "displacement"
  std::string file;                 // CSV, relative to the case file
  double exclude_within = 0;        // m
  std::optional<double> state;      // key `at`: stretch, time or cycle; default: final (metric), all (field)
  std::string kind;                 // "published" or "reference"
  std::string source;
  Location at;
};

struct ShortInput {              // [short]: what `riven verify --short` runs
  std::vector<std::string> set;  // overrides as for --set
  std::vector<ExpectInput> expect;
  Location at;
};

struct StudyInput {                // [study]: what `riven sweep` runs and draws if it is given no keys
  std::vector<std::string> keys;   // as on its command line
  std::vector<std::string> plots;  // as for --plot
  Location at;
};

struct Case {
  std::filesystem::path file;
  std::string title;
  std::string source;
  std::vector<TableInput> tables;
  GeometryInput geometry;
  std::vector<FieldInput> fields;
  std::vector<HoleInput> holes;
  std::vector<CrackInput> cracks;
  std::vector<InclusionInput> inclusions;
  std::vector<SetInput> sets;
  ModelInput model;
  std::vector<MaterialInput> materials;
  std::vector<InterfaceInput> interfaces;
  FailureInput failure;
  std::vector<LoadInput> loads;
  std::vector<InitialInput> initials;
  std::optional<ContactInput> contact;
  std::vector<ImpactorInput> impactors;
  SolverInput solver;
  OutputInput output;
  std::vector<ProbeInput> probes;
  std::vector<ExpectInput> expects;
  std::optional<ShortInput> short_run;
  std::optional<StudyInput> study;
};

}  // namespace riven
