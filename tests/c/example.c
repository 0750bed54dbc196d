/* A renderer's loop in C: photons from a lamp, frame after frame, and the irradiance at samples of a floor. */
#include <detp.h>
#include <stdio.h>
#include <stdlib.h>

enum { sample_count = 5000, ray_count = 20000 };

static float samples[sample_count][6];      /* position, normal: as a renderer keeps them */
static double origins[3][ray_count];        /* x, y, z in arrays of their own */
static float directions[ray_count][3];
static float powers[ray_count][3];          /* red, green, blue */
static double irradiance[sample_count][3], error_of[sample_count][3];
static uint64_t offsets[sample_count + 1];

static float random_number(void) { return (float)rand() / (float)RAND_MAX; }

static void trace(void) {
  for (int i = 0; i < ray_count; ++i) {
    origins[0][i] = random_number(), origins[1][i] = random_number(), origins[2][i] = 1;
    directions[i][0] = random_number() - 0.5F, directions[i][1] = random_number() - 0.5F;
    directions[i][2] = -1;
    powers[i][0] = 1.2F / ray_count, powers[i][1] = 1.0F / ray_count, powers[i][2] = 0.6F / ray_count;
  }
}

int main(void) {
  detp_error error;
  detp_plan *plan = NULL, *smaller = NULL;
  detp_scratch *scratch = NULL;
  for (int i = 0; i < sample_count; ++i)
    samples[i][0] = random_number(), samples[i][1] = random_number(), samples[i][5] = 1;
  detp_discs discs = DETP_INIT(detp_discs);
  discs.count = sample_count;
  discs.centres.x = samples[0], discs.centres.stride = sizeof(samples[0]);
  discs.normals.x = samples[0] + 3, discs.normals.stride = sizeof(samples[0]);
  discs.radii.of_all = 0.03;
  detp_rays rays = DETP_INIT(detp_rays);
  rays.count = ray_count;
  rays.origins.x = origins[0], rays.origins.y = origins[1], rays.origins.z = origins[2], rays.origins.type = DETP_DOUBLE;
  rays.directions.x = directions[0], rays.directions.stride = sizeof(directions[0]);
  detp_numbers bands[3] = {{0}}; /* one search finds the irradiance in all three */
  for (int band = 0; band < 3; ++band) bands[band].data = powers[0] + band, bands[band].stride = sizeof(powers[0]);
  rays.powers = bands[0], rays.further_powers = bands + 1, rays.further_bands = 2;
  rays.lengths.of_all = 9;
  trace();
  if (detp_plan_create(&discs, &rays, NULL, &plan, &error) || detp_scratch_create(&scratch, &error)) goto failed;
  for (int pass = 0; pass < 3; ++pass) {
    detp_plan_facts facts = DETP_INIT(detp_plan_facts);
    detp_found found = DETP_INIT(detp_found);
    detp_search_options options = DETP_INIT(detp_search_options);
    found.irradiance = irradiance[0], found.standard_error = error_of[0], found.bands = 3;
    options.pairs = 1;
    if (detp_plan_describe(plan, &facts, &error) || detp_search(plan, &rays, scratch, &options, &found, &error)) goto failed;
    uint32_t *hits = malloc((size_t)(found.total_hits + 1) * sizeof *hits);
    if (hits == NULL || detp_pairs(scratch, offsets, hits, (size_t)found.total_hits, &error)) goto failed;
    printf("%s %s, predicted %.2g s: %llu hits; sample 0: %.3f %.3f %.3f +- %.3f of %llu rays\n", facts.technique, facts.parameters,
           facts.predicted_seconds, (unsigned long long)found.total_hits, irradiance[0][0], irradiance[0][1], irradiance[0][2], error_of[0][0],
           (unsigned long long)(offsets[1] - offsets[0]));
    free(hits);
    if (offsets[sample_count] != found.total_hits || found.total_hits == 0) return 1;
    if (detp_plan_with_radius(plan, 0.03 * (pass == 0 ? 0.8 : 0.64), 0, &smaller, &error)) goto failed;
    detp_plan_free(&plan);
    plan = smaller, smaller = NULL;
    trace();
  }
  detp_plan_free(&plan);
  detp_scratch_free(&scratch);
  return 0;
failed:
  fprintf(stderr, "%s\n", error.text);
  return 1;
}
