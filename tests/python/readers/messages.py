"""Full messages of ROS 1, ROS 2 and MoveIt, as dictionaries with every field of their definitions. For tests only.

The robot is that of `ARM`: j1 and j2 are planned for, j3 is held at 0.25, `follow` mimics j1, and `mount` is fixed.
"""

ARM = """<robot name="arm">
  <link name="base"><collision><geometry><box size="0.1 0.1 0.02"/></geometry></collision></link>
  <link name="l1"><collision><origin xyz="0.25 0 0"/><geometry><box size="0.5 0.02 0.02"/></geometry></collision></link>
  <link name="l2"><collision><origin xyz="0.25 0 0"/><geometry><box size="0.5 0.02 0.02"/></geometry></collision></link>
  <link name="l3"><collision><origin xyz="0.25 0 0"/><geometry><box size="0.5 0.02 0.02"/></geometry></collision></link>
  <link name="tip"><collision><geometry><sphere radius="0.02"/></geometry></collision></link>
  <link name="flag"><collision><origin xyz="-0.1 0 0"/><geometry><box size="0.2 0.02 0.02"/></geometry></collision></link>
  <joint name="j1" type="revolute"><parent link="base"/><child link="l1"/><axis xyz="0 0 1"/><origin xyz="0 0 0.1"/>
    <limit lower="-3" upper="3" effort="1" velocity="3"/></joint>
  <joint name="j2" type="revolute"><parent link="l1"/><child link="l2"/><axis xyz="0 0 1"/><origin xyz="0.5 0 0.05"/>
    <limit lower="-3" upper="3" effort="1" velocity="3"/></joint>
  <joint name="j3" type="revolute"><parent link="l2"/><child link="l3"/><axis xyz="0 0 1"/><origin xyz="0.5 0 0.05"/>
    <limit lower="-3" upper="3" effort="1" velocity="3"/></joint>
  <joint name="mount" type="fixed"><parent link="l3"/><child link="tip"/><origin xyz="0.5 0 0"/></joint>
  <joint name="follow" type="revolute"><parent link="base"/><child link="flag"/><axis xyz="0 0 1"/>
    <origin xyz="0 0 0.5"/><limit lower="-3" upper="3" effort="1" velocity="3"/><mimic joint="j1" multiplier="0.5"/></joint>
</robot>"""

SRDF = """<robot name="arm">
  <group name="whole"><joint name="j1"/><joint name="j2"/></group>
  <group name="shoulder"><joint name="j1"/></group>
</robot>"""

JOINTS = ["j1", "j2", "j3", "follow"]


def duration(ros, seconds):
    whole, rest = int(seconds), round((seconds - int(seconds)) * 1e9)
    return {"secs": whole, "nsecs": rest} if ros == 1 else {"sec": whole, "nanosec": rest}


def header(ros, frame=""):
    return {**({"seq": 0} if ros == 1 else {}), "stamp": duration(ros, 0), "frame_id": frame}


def point3(x=0.0, y=0.0, z=0.0):
    return {"x": x, "y": y, "z": z}


def pose(x=0.0, y=0.0, z=0.0, turned=False):
    """A pose with the identity as its rotation, or with a rotation about a general axis."""
    orientation = {**point3(0.1, 0.7, 0.1), "w": 0.7} if turned else {**point3(), "w": 1.0}
    return {"position": point3(x, y, z), "orientation": orientation}


def transform(x=0.0, y=0.0, z=0.0):
    return {"translation": point3(x, y, z), "rotation": {**point3(), "w": 1.0}}


def twist(x=0.0):
    return {"linear": point3(x), "angular": point3()}


def joint_trajectory(ros):
    """Three rows, in which j1 goes from -0.3 to 0.3, and j2 from 0.4 to 0.1."""

    def at(time, j1, j2, v1, v2, a1, a2):
        return {
            "positions": [j1, j2, 0.25, 0.5 * j1], "velocities": [v1, v2, 0.0, 0.5 * v1],
            "accelerations": [a1, a2, 0.0, 0.5 * a1], "effort": [0.5, 0.5, 0.5, 0.5], "time_from_start": duration(ros, time),
        }  # fmt: skip

    return {
        "header": header(ros), "joint_names": list(JOINTS),
        "points": [at(0, -0.3, 0.4, 0.0, 0.0, 0.1, 0.0), at(1, 0.0, 0.25, 0.2, -0.1, 0.0, 0.1),
                   at(2.5, 0.3, 0.1, 0.0, 0.0, 0.0, -0.1)],
    }  # fmt: skip


def multi_dof_trajectory(ros):
    return {"header": header(ros), "joint_names": [], "points": []}


def robot_trajectory(ros):
    return {"joint_trajectory": joint_trajectory(ros), "multi_dof_joint_trajectory": multi_dof_trajectory(ros)}


def robot_state(ros, j1=-0.3, j2=0.4):
    return {
        "joint_state": {"header": header(ros), "name": list(JOINTS), "position": [j1, j2, 0.25, 0.5 * j1],
                        "velocity": [0.0] * 4, "effort": [0.0] * 4},
        "multi_dof_joint_state": {"header": header(ros), "joint_names": [], "transforms": [], "twist": [], "wrench": []},
        "attached_collision_objects": [], "is_diff": False,
    }  # fmt: skip


def follow_goal(ros):
    goal = {
        "trajectory": joint_trajectory(ros), "path_tolerance": [], "goal_tolerance": [],
        "goal_time_tolerance": duration(ros, 0),
    }  # fmt: skip
    if ros == 2:
        goal |= {key: [] for key in ("component_path_tolerance", "component_goal_tolerance")}
        goal["multi_dof_trajectory"] = multi_dof_trajectory(2)
    return goal


def trajectory_messages():
    """Each type of message that gives a trajectory, by a name."""
    found = {}
    for ros in (1, 2):
        goal_id = {"goal_id": {"stamp": duration(1, 0), "id": "7"}} if ros == 1 else {"goal_id": {"uuid": [0] * 16}}
        found |= {
            f"JointTrajectory of ROS {ros}": joint_trajectory(ros),
            f"RobotTrajectory of ROS {ros}": robot_trajectory(ros),
            f"DisplayTrajectory of ROS {ros}": {
                "model_id": "arm", "trajectory": [robot_trajectory(ros)], "trajectory_start": robot_state(ros)},
            f"MotionPlanResponse of ROS {ros}": {
                "trajectory_start": robot_state(ros), "group_name": "whole", "trajectory": robot_trajectory(ros),
                "planning_time": 0.5,
                "error_code": {"val": 1} if ros == 1 else {"val": 1, "message": "", "source": ""}},
            f"FollowJointTrajectory of ROS {ros}": follow_goal(ros),
            f"FollowJointTrajectory, in an action of ROS {ros}": {
                **({"header": header(1)} if ros == 1 else {}), **goal_id, "goal": follow_goal(ros)},
        }  # fmt: skip
    return found


def primitive(type_, dimensions, ros):
    return {"type": type_, "dimensions": dimensions, **({"polygon": {"points": []}} if ros == 2 else {})}


def collision_object(ros, id_, **parts):
    return {
        "header": header(ros, "base"), "pose": pose(1.2, 0.8, 0.2, True), "id": id_, "type": {"key": "", "db": ""},
        "primitives": [], "primitive_poses": [], "meshes": [], "mesh_poses": [], "planes": [], "plane_poses": [],
        "subframe_names": [], "subframe_poses": [], "operation": 0, **parts,
    }  # fmt: skip


def mesh():
    vertices = [point3(0, 0, 0), point3(0.2, 0, 0), point3(0, 0.2, 0), point3(0, 0, 0.2)]
    faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
    return {"triangles": [{"vertex_indices": face} for face in faces], "vertices": vertices}


def planning_scene(ros):
    """A scene with a box and a cylinder in one object, a mesh, a map of one cube, and a matrix that allows some pairs."""
    names = ["base", "l1", "l2", "l3", "tip", "flag", "crate", "wedge"]
    allowed = {("base", "flag"), ("flag", "l1"), ("flag", "l2")}
    rows = [{"enabled": [(a, b) in allowed or (b, a) in allowed for b in names]} for a in names]
    return {
        "name": "", "robot_state": robot_state(ros), "robot_model_name": "arm", "fixed_frame_transforms": [],
        "allowed_collision_matrix": {
            "entry_names": names, "entry_values": rows, "default_entry_names": [], "default_entry_values": []},
        "link_padding": [{"link_name": "l2", "padding": 0.001}], "link_scale": [{"link_name": "l2", "scale": 1.0}],
        "object_colors": [],
        "world": {
            "collision_objects": [
                collision_object(ros, "crate", header=header(ros, "world"),
                                 primitives=[primitive(1, [0.2, 0.3, 0.1], ros), primitive(3, [0.5, 0.05], ros)],
                                 primitive_poses=[pose(0.05, 0.02, 0.1, True), pose(-0.1, 0.3, -0.5, True)]),
                collision_object(ros, "wedge", meshes=[mesh()], mesh_poses=[pose(0.1, -0.1, 0.3, True)]),
            ],
            # One cube, the first of the eight parts of the whole map. It has 2^15 cells of 10 µm on each side.
            "octomap": {"header": header(ros, "base"), "origin": pose(0.5, 1.5, 0.4, True),
                        "octomap": {"header": header(ros, "base"), "binary": True, "id": "OcTree", "resolution": 1e-5,
                                    "data": [2, 0]}},
        },
        "is_diff": False,
    }  # fmt: skip


def constraints():
    return {"name": "", "joint_constraints": [], "position_constraints": [], "orientation_constraints": [],
            "visibility_constraints": []}  # fmt: skip


def joint_constraint(joint, position):
    return {"joint_name": joint, "position": position, "tolerance_above": 0.001, "tolerance_below": 0.001, "weight": 1.0}


def motion_plan_request(ros):
    goal = {**constraints(), "joint_constraints": [joint_constraint("j1", 0.3), joint_constraint("j2", 0.1)]}
    request = {
        "workspace_parameters": {"header": header(ros), "min_corner": point3(), "max_corner": point3()},
        "start_state": robot_state(ros), "goal_constraints": [goal], "path_constraints": constraints(),
        "trajectory_constraints": {"constraints": []}, "reference_trajectories": [], "pipeline_id": "", "planner_id": "",
        "group_name": "whole", "num_planning_attempts": 1, "allowed_planning_time": 5.0, "max_velocity_scaling_factor": 0.5,
        "max_acceleration_scaling_factor": 0.5, "cartesian_speed_limited_link": "", "max_cartesian_speed": 0.0,
    }  # fmt: skip
    if ros == 1:
        request["cartesian_speed_end_effector_link"] = request.pop("cartesian_speed_limited_link")
        del request["pipeline_id"]
    return request
