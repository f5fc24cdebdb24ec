"""The Firefly of [furrer2016] as its files have it, restated here, so that what is compared shares no numbers.

`firefly.xacro`, `firefly.yaml` and `lee_controller_firefly.yaml` of `ethz-asl/rotors_simulator` hold parameters and
gains. Neither they nor [lee2010] print figures of a step response; those come from the published equations, integrated
by `reference`.
"""

from __future__ import annotations

import math

import numpy as np

GRAVITY_MPS2 = 9.81
MASS_KG = 1.56779
INERTIA_KGM2 = np.array([0.0347563, 0.0458929, 0.0977])
ARM_M = 0.215
ROTOR_ABOVE_M = 0.037
ANGLES_RAD = np.array([0.52359877559, 1.57079632679, 2.61799387799, -2.61799387799, -1.57079632679, -0.52359877559])
TURNS = np.array([1.0, -1.0, 1.0, -1.0, 1.0, -1.0])
MOTOR_CONSTANT = 8.54858e-06
MOMENT_CONSTANT = 0.016
UP_S, DOWN_S = 0.0125, 0.025
MOST_RADPS = 838.0
ROTOR_DRAG, ROLLING_MOMENT = 8.06428e-05, 1e-06
POSITION_GAIN, VELOCITY_GAIN = 6.0, 4.7
ATTITUDE_GAIN = np.array([3.0, 3.0, 0.15])
RATE_GAIN = np.array([0.52, 0.52, 0.18])

HOVER_RADPS = math.sqrt(MASS_KG * GRAVITY_MPS2 / (6 * MOTOR_CONSTANT))
"""The speed at which six rotors carry the weight."""
THRUST_TO_WEIGHT = 6 * MOTOR_CONSTANT * MOST_RADPS**2 / (MASS_KG * GRAVITY_MPS2)
