"""What 5 % noise costs in a scene, and a run that stops there: python3 noise.py scene.obj"""

import sys

import detp

scene = sys.argv[1] if len(sys.argv) > 1 else "@cornell"
answer = detp.ask("accuracy", scene, "--target-noise", "5%", "--effort", "quick")["answer"]
print(answer["text"])
setting = ["--estimator", answer["estimator"], "--target-noise", "5%"]
setting += ["--disc-radius", answer["disc_radius"]] if answer["disc_radius"] else []
run = detp.ask("run", scene, *setting)
print(f"run until 5 %: noise {run['noise']:.2%} after {run['photons']:.3g} photons, {run['until_seconds']:.2g} s")
