#version 3.7;
// A point light of 20 W/sr (fade_power 2: it falls off with the square of the distance), a glass ball, a wall.
global_settings { assumed_gamma 1 photons { count 100000 save_file "wall.ph" } }
camera { location <0, 1.5, -4> look_at <0, 1, 0> }
light_source { <2, 3, -3>, rgb 10 fade_distance 1 fade_power 2 photons { refraction on reflection off } }
plane { z, 1 pigment { rgb 0.8 } finish { diffuse 0.8 ambient 0 } }
sphere {
  <0, 1, 0>, 0.5
  pigment { rgbt 1 } finish { diffuse 0 ambient 0 specular 0 } interior { ior 1.5 }
  photons { target refraction on reflection off }
}
