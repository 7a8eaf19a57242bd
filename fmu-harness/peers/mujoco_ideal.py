"""The mechanism with ideal joints in MuJoCo: crank, rod and slider as a chain of hinges and a slide, closed by an
equality constraint, which is soft, as MuJoCo's constraints are; made as stiff as its solver allows at the step.

The crank turns freely from its start speed. Reported are the angles of crank and rod and the slider's place, so that
the gap of the soft constraint counts as an error. Steps are fixed.
"""

import math

import mujoco

import job as jobs

STIFF = 2.1  # [steps] Least time constant of a constraint that MuJoCo takes is two steps.


def model(a, integrator, step):
    r, l = a["crank.length"], a["rod.length"]
    # Nothing turns about the other two axes.
    body = lambda name: f'mass="{a[name + ".mass"]}" diaginertia="{" ".join(3 * [repr(a[name + ".inertia"])])}"'
    return mujoco.MjModel.from_xml_string(f"""
<mujoco>
  <compiler angle="radian"/>
  <option timestep="{step!r}" integrator="{integrator}" gravity="0 {-a["gravity"]!r} 0" tolerance="1e-14"
          iterations="200" solver="Newton" cone="elliptic"><flag contact="disable"/></option>
  <worldbody>
    <body name="crank">
      <joint type="hinge" axis="0 0 1"/>
      <inertial pos="{a["crank.com.x"]} {a["crank.com.y"]} 0" {body("crank")}/>
      <body name="rod" pos="{r} 0 0">
        <joint type="hinge" axis="0 0 1"/>
        <inertial pos="{a["rod.com.x"]} {a["rod.com.y"]} 0" {body("rod")}/>
        <site name="small_end" pos="{l} 0 0"/>
      </body>
    </body>
    <body name="slider" pos="{r + l} 0 0">
      <joint type="slide" axis="1 0 0"/>
      <inertial pos="0 0 0" {body("slider")}/>
      <site name="pin"/>
    </body>
  </worldbody>
  <equality>
    <connect site1="small_end" site2="pin" solref="{STIFF * step!r} 1" solimp="0.9999 0.9999 0.001"/>
  </equality>
</mujoco>""")


def march(job, method, step, points):
    a, span = job["parameters"], job["span"]
    m = model(a, method, step)
    data = mujoco.MjData(m)
    r, l = a["crank.length"], a["rod.length"]
    crank, speed = job["start"]
    rod = math.asin(-r * math.sin(crank) / l)
    rod_speed = -r * math.cos(crank) * speed / (l * math.cos(rod))
    data.qpos[:] = crank, rod - crank, r * math.cos(crank) + l * math.cos(rod) - r - l
    data.qvel[:] = speed, rod_speed - speed, -r * math.sin(crank) * speed - l * math.sin(rod) * rod_speed
    steps = round(span / points / step)
    found = []
    for _ in range(points):
        mujoco.mj_step(m, data, steps)
        crank, rod, shift = data.qpos
        found.append([crank, crank + rod, (r + l + shift) / r])
    return found, steps * points, 0


def main():
    job, method = jobs.load()
    jobs.answer(job, lambda step, points: march(job, method, step, points), "measured")


if __name__ == "__main__":
    main()
