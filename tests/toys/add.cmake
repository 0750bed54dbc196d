# Copies the sources, adds a technique, an estimator, an effect, a scene and a format to the copy as CONTRIBUTING.md says, builds what
# they need and runs them. Called with
# -D SOURCE=<top of the project> -D BUILD=<build tree> -D GENERATOR=<generator> -D COMPILER=<C++ compiler>.
cmake_policy(VERSION 3.25)
set(here ${SOURCE}/tests/toys)
set(copy ${BUILD}/toys/copy)
file(REMOVE_RECURSE ${BUILD}/toys)
file(COPY ${SOURCE}/CMakeLists.txt ${SOURCE}/model ${SOURCE}/sim ${SOURCE}/validate DESTINATION ${copy})

# add(file before line): inserts lines before the text, which the file must contain once.
function(add file before lines)
  file(READ ${copy}/${file} text)
  string(FIND "${text}" "${before}" first)
  string(FIND "${text}" "${before}" last REVERSE)
  if(first EQUAL -1 OR NOT first EQUAL last)
    message(FATAL_ERROR "${file}: has not once: ${before}")
  endif()
  string(REPLACE "${before}" "${lines}${before}" text "${text}")
  file(WRITE ${copy}/${file} "${text}")
endfunction()

# 1. The parameters.
add(model/vocabulary/parameters.hpp "using Parameters = std::variant<"
    "struct EachPairParameters {\n  int step = 1;\n  bool operator==(const EachPairParameters&) const = default;\n};\n\n")
add(model/vocabulary/parameters.hpp ", PhotonMapParameters>" ", EachPairParameters")

# 2. The record.
add(model/vocabulary/technique.hpp "}  // namespace records"
    "inline constexpr std::array each_pair{number<&EachPairParameters::step>(\n    \"step\", \"step\", 1, 100, int64_t{2}, \"discs from one to the next\")};\n\n")
add(model/vocabulary/technique.hpp "\n};\n\nusing Parameter =" ",\n  each_pair")
add(model/vocabulary/technique.hpp "};\n\n[[nodiscard]] constexpr const TechniqueRecord& record_of("
    ",\n    TechniqueRecord{.technique = Technique::each_pair, .name = \"each-pair\", .parameters = records::each_pair,\n                    .defaults = EachPairParameters{}, .ray_by_ray = true,\n                    .division = {.plain = Division::rays, .simd = Division::rays}}")

# 3 and 4. The search, and its line.
configure_file(${here}/search.cpp ${copy}/sim/technique/each_pair.cpp COPYONLY)
add(sim/technique/technique.cpp ";\n\nnamespace {" ", prepare_each_pair")
add(sim/technique/technique.cpp "}};\n\n}  // namespace" "    {Technique::each_pair, prepare_each_pair},\n")

# 5 and 6. The closed form, if there is one, and its line.
configure_file(${here}/closed_form.cpp ${copy}/model/techniques/each_pair.cpp COPYONLY)
add(model/techniques/registry.cpp ";\n\nnamespace {" ", model_each_pair")
add(model/techniques/registry.cpp "};\n\n}  // namespace" "    {Technique::each_pair, model_each_pair},\n")

# An estimator: its record, and a file.
configure_file(${here}/estimator.cpp ${copy}/sim/estimate/toy_hits.cpp COPYONLY)
add(sim/estimate/estimator.hpp ";\n\nenum class Estimator {" ", prepare_toy_hits")
add(sim/estimate/estimator.hpp "  gather  " "  toy_hits,\n")
add(sim/estimate/estimator.hpp "    EstimatorRecord{.estimator = Estimator::gather"
    "    EstimatorRecord{.estimator = Estimator::toy_hits, .name = \"toy-hits\", .prepare = prepare_toy_hits},\n")

# An effect: a file, and a line in the list of names and in the list of effects.
configure_file(${here}/effect.cpp ${copy}/sim/effects/few_rays.cpp COPYONLY)
add(sim/effects/all_effects.hpp "\n/// In the order" "extern const Effect few_rays;\n")
add(sim/effects/all_effects.hpp "};\n\n}  // namespace" ", &few_rays")

# A scene: a file, its declaration and its line.
configure_file(${here}/scene.cpp ${copy}/sim/scene/built_in/square.cpp COPYONLY)
add(sim/scene/built_in/built_in.hpp "/// A new scene is" "[[nodiscard]] LitMesh square();\n\n")
add(sim/scene/built_in/built_in.hpp "};\n\n/// A point uniform" ", BuiltIn{\"@square\", square}")

# A format of meshes: a file, its declaration and its line.
configure_file(${here}/format.cpp ${copy}/sim/files/corners_file.cpp COPYONLY)
add(sim/files/mesh_file.cpp "constexpr std::array formats{" "}\nMesh read_corners(const std::string& path, Notices& notices, std::stop_token stop);\nnamespace {\n")
add(sim/files/mesh_file.cpp "};\n\n}  // namespace\n\nstd::string mesh_suffixes" ", MeshFormat{\".corners\", read_corners}")

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE failed OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(failed)
    message(FATAL_ERROR "${ARGN}\n${output}")
  endif()
endfunction()
# -O1 compiles the kernels in half the time; they need no instruction set but the compiler's own.
run(${CMAKE_COMMAND} -S ${here} -B ${BUILD}/toys/tree -G ${GENERATOR} -D DETP_COPY=${copy}
    -D CMAKE_BUILD_TYPE=Release "-D CMAKE_CXX_FLAGS_RELEASE=-O1 -DHWY_COMPILE_ONLY_STATIC" -D CMAKE_UNITY_BUILD_BATCH_SIZE=20 -D CMAKE_UNITY_BUILD=ON -D CMAKE_CXX_COMPILER=${COMPILER})
run(${CMAKE_COMMAND} --build ${BUILD}/toys/tree --target toy)
run(${BUILD}/toys/tree/toy)
