#include "command_line.hpp"

namespace detp::cli {

std::string_view short_help(std::string_view command) {
  if (command == "choose")
    return R"(The fastest technique and its parameters, and why
Usage: detp choose [SCENE] [options]

What is searched
  SCENE              a mesh file, or built in: @tree, @room:7 ...
  --rays N           how many rays, as 100k; default: 100k
  --disc-radius D    a length, or a share of the scene, as 1%
  --discs FILE, --ray-file FILE
                     your own discs and rays; columns below
How the choice is made
  --analyze          run the candidates: was the choice right?
  --technique NAME   choose among these techniques only; --disable: not these
  --map              the fastest technique for many numbers of rays and radii
  --rigor NAME       how closely to look: estimate, structural, pilot, measure
Output
  --verbose          all candidates, what was ruled out and why, effects
  --format NAME      text, json or csv; -o FILE writes it to a file
  --time-limit S     stop after S seconds and show what there is

Discs  x,y,z,nx,ny,nz and radius (or --disc-radius), as CSV, PLY, NPY or NPZ.
Rays   ox,oy,oz,dx,dy,dz and, if wanted, length, power, photon, landing.
Example: detp choose @tree --rays 100000 --disc-radius 1% --analyze
Example: detp choose @tree --map --disc-radius 1%,4%,16% -o map.svg
All options: detp choose --help all
Fields of the answer: detp choose --help fields
)";
  if (command == "run")
    return R"(The hits and the irradiance, by one technique
Usage: detp run [SCENE] [options]

What is searched
  SCENE              a mesh file, or built in: @tree, @room:7 ...
  --rays N           how many rays, as 100k; default: 100k
  --disc-radius D    a length, or a share of the scene, as 1%
  --discs FILE, --ray-file FILE
                     your own discs and rays; columns below
  --columns ox=px,.. what your files call them
How
  --technique NAME   how pairs are found: box-tree, octree, grid ...;
                     default: the one that detp choose would choose
  --estimator NAME   how photons become irradiance: disc (the default), nearest,
                     triangle-hits, variable-radius, area-corrected, gather
Until when
  --target-noise E   run until the noise is below, as 5%
  --target-error E   the same of noise and bias together
  --noise-of NAME    of several bands: whose noise; default: all, of their sum
  --time-limit S     stop after S seconds and show what there is
Output
  --per-disc FILE    hits and irradiance of each disc: .csv, .ply, .vtp, .npy
  --per-face FILE    light that lands on each triangle, likewise
  --picture FILE     the surface in the colours of its irradiance: .png, .svg
  --standard-error   errors in these files and pictures
  --pairs FILE       every pair of a ray and a disc that it crosses
  --verbose          also effects, and counts with their predictions
  --format NAME      text, json or csv; -o FILE writes it to a file

Discs  x,y,z,nx,ny,nz and radius (or --disc-radius), as CSV, PLY, NPY or NPZ.
Rays   ox,oy,oz,dx,dy,dz and, if wanted, length, power, photon, landing.
Units  irradiance: the rays' power over area. Ke: radiance of a face's front.
Example: detp run @cornell --target-noise 5%
Example: detp run @tree --rays 100000 --technique octree --per-disc out.csv
All options: detp run --help all
Fields of the answer: detp run --help fields
)";
  if (command == "accuracy")
    return R"(What accuracy costs in time: rays, setting and estimator for an error
Usage: detp accuracy SCENE [options]

The question, one of
  --target-noise E   noise to reach, as 5%; default: 5%
  --target-error E   noise and bias together to reach
  --time-budget S    the most accurate answer in S seconds, tracing included
For what
  SCENE              a mesh file, or built in: @cornell, @room:7 ...
  --disc-radius D    radii near this one, a length or a share, as 1%
  --discs FILE       the discs in question; default: at the scene's samples
  --material NAME    errors of the samples on these materials only
How
  --estimators NAME,...
                     disc, variable-radius, nearest, area-corrected,
                     triangle-hits, gather; default: all
  --check            run the answer once
  --reference FILE   compare with this irradiance (made if there is none)
  --effort NAME      how long planning may take: quick, default, thorough
Output
  --format NAME      text, json or csv; -o FILE writes it to a file
  --time-limit S     stop after S seconds and show what there is

Errors are root mean squares over the samples by area, relative to the root
mean square irradiance.
Example: detp accuracy @cornell --target-noise 5%
Example: detp accuracy @cornell --time-budget 2
All options: detp accuracy --help all
Fields of the answer: detp accuracy --help fields
)";
  if (command == "model")
    return R"(The closed forms for one technique
Usage: detp model [SCENE] [options]

The workload, in numbers or from a scene
  --rays N           how many rays, as 100k; default: 100k
  --samples N        how many samples
  --disc-radius D    a length, or a share of the scene, as 1%
  --scene-side S     side of the cube of samples; --sphere-radius R: of S0
  --dimension D      3: samples fill the cube; 2: they lie on its faces
  SCENE              a mesh file, or built in: @tree, @cornell ...
The technique
  --technique NAME   default: sphere-cache
  --ratio Q          ratio of the radii of nested spheres, also a range
  --spheres K        how many: a number, max (the form's own k) or best
  --form NAME        corrected, or published: as the paper has it
  --costs LIST       unit costs in seconds, as t=2e-9,u=3e-9 (--help all names
                     them); default: 1 for each test, so that times are counts
Output
  --verbose          the whole record: every sphere, every cost
  --format NAME      text, json or csv; -o FILE writes it to a file

Numbers may be lists and ranges, as 1%,2%,4% and 0.3:0.9:0.05: a row for each.
Example: detp model --rays 1e5 --samples 1e5 --disc-radius 0.01 --scene-side 2
All options: detp model --help all
Fields of the answer: detp model --help fields
)";
  if (command == "validate")
    return R"(Each formula against what simulation counts, with a verdict
Usage: detp validate [SCENE] [options]

For what
  SCENE              a mesh or built-in scene; default: samples in a cube
  --rays N           how many rays or lines, as 1M
  --samples N        how many samples
  --disc-radius D    a length, or a share of the scene, as 1%
  --ratio Q          sphere caches with this ratio of radii
  --form NAME        published or corrected formulas alone; default: both
  --experiments NAME,...
                     choice, effects, lines, sphere-cache, hierarchies, index,
                     errors; default: all
How long
  --effort NAME      default, or thorough: every formula over its whole range
  --until-relative-error E
                     count until each relative error is below
  --time-limit S     stop after S seconds and show what there is
Output
  --format NAME      text, json or csv; -o FILE writes it to a file

Exit code 1: a corrected formula was refuted, or a negative control missed.
Example: detp validate --experiments sphere-cache --ratio 0.65
All options: detp validate --help all
Fields of the answer: detp validate --help fields
)";
  if (command == "scene")
    return R"(What is in a scene; writes scenes, discs and rays to files
Usage: detp scene [SCENE] [options]

What
  SCENE              a mesh file, or built in: @uniform, @tree,
                     @tree-coarse, @courtyard, @cornell, @caustic, @interior,
                     @furnace, @sunlit; families with a seed: @room:7, @plant:7,
                     @machine:7, @terrain:7, @shells:7, @details:7
  --rays N           how many rays, as 100k; default: 100k
  --disc-radius D    a length, or a share of the scene, as 1%
  --field NAME       isotropic (lines) or photons (paths from the lights)
  --light NAME,...   lights to place: area, point, spot, directional ...
Output
  --write-mesh FILE  the triangles as PLY
  --write-discs FILE the discs, as CSV, PLY or NPY by the file's name
  --write-rays FILE  the rays, likewise
  --format NAME      text, json or csv; -o FILE writes it to a file

Example: detp scene @tree --rays 100000 --write-rays paths.csv
All options: detp scene --help all
Fields of the answer: detp scene --help fields
)";
  if (command == "bench")
    return R"(Our techniques and Embree on the same rays and discs, timed in turns
Usage: detp bench [SCENE] [options]

What is searched
  SCENE              a mesh or a built-in scene; default: the effort's set
  --rays N,...       a list or a range, as 1k,100k
  --disc-radius D,...
                     lengths or shares of the scene, as 1%,4%
  --effort NAME      quick (a minute) or thorough (half an hour)
How
  --techniques NAME,...
                     ours; default: all exact ones
  --repeat N         rounds, at most; medians are shown; default: 5
  --regret           instead: how much slower choices are than the best of all
Output
  --format NAME      text, json or csv; -o FILE writes it to a file
  --time-limit S     stop after S seconds and show what there is

Example: detp bench @tree --rays 100k --disc-radius 1%
All options: detp bench --help all
Fields of the answer: detp bench --help fields
)";
  if (command == "calibrate")
    return R"(The unit costs of this machine, saved for later commands
Usage: detp calibrate [options]

  --seconds S        time for the measurements; default: 8
  --threads N        at most so many; default: all cores
  -o FILE            save the unit costs there instead
  --format NAME      text, json or csv
  --time-limit S     stop after S seconds

Without it, unit costs are those of another machine, scaled by a probe of 0.2 s.
Let nothing else run meanwhile.
Example: detp calibrate --seconds 10
All options: detp calibrate --help all
Fields of the answer: detp calibrate --help fields
)";
  if (command == "report")
    return R"(One page that answers, then shows: choice, accuracy, verdicts
Usage: detp report SCENE -o FILE.html [options]

  SCENE              a mesh file, or built in: @tree, @cornell ...
  -o FILE.html       the page
  --rays N           how many rays, as 100k; default: 100k
  --disc-radius D    a length, or a share of the scene, as 1%
  --target-noise E   noise whose cost is asked for; default: 5%
  --target-error E   noise and bias together instead
  --quick            smaller map, pilots of some seconds
  --time-limit S     stop after S seconds and show what there is

Example: detp report @tree -o report.html
All options: detp report --help all
Fields of the answer: detp report --help fields
)";
  return {};
}

}  // namespace detp::cli
