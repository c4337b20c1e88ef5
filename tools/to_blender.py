# A scene of `make corpus` for Blender, 3.3 or later:
#
#   blender -b --factory-startup -P tools/to_blender.py -- NAME
#
# NAME.obj, its .mtl and NAME.view become NAME.blend. Ke, a radiosity, becomes the
# radiance Ke / pi, and pixels times pi are W/m^2 (tests/cycles.py renders such). Backs
# are black. Lengths are scaled to LENGTH: of lamps in small units Cycles 3.4 always
# samples the solid angle, by its fast_acosf(), and loses light.
import math, os, re, sys
import bpy
from mathutils import Matrix, Vector

LENGTH = float(os.environ.get('LENGTH', 1))  # of the scene
name = os.path.abspath(sys.argv[-1])
read = lambda path: open(path).read()
lines = [line.split('#')[0].split() for line in open(name + '.view')]
view = {'up': [0, 1, 0], 'fov': [45]}
view.update((key, list(map(float, rest))) for key, *rest in filter(None, lines))
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.wm.obj_import(filepath=name + '.obj', forward_axis='Y', up_axis='Z')
scene, parts = bpy.context.scene, list(bpy.context.scene.objects)
corners = [Vector(corner) for part in parts for corner in part.bound_box]
scale = LENGTH / max(max(axis) - min(axis) for axis in zip(*corners))
for part in parts:
    part.scale = scale, scale, scale
library = re.search(r'^mtllib (\S+)', read(name + '.obj'), re.M).group(1)
library = read(os.path.join(os.path.dirname(name), library))
for material in bpy.data.materials:
    own = re.search(r'^newmtl %s$(.*?)(?=^newmtl|\Z)' % re.escape(material.name), library,
                    re.M | re.S).group(1)
    nodes, link = material.node_tree.nodes, material.node_tree.links.new
    nodes.clear()
    back, both = nodes.new('ShaderNodeNewGeometry'), nodes.new('ShaderNodeAddShader')
    for k, (word, kind) in enumerate((('Kd', 'BsdfDiffuse'), ('Ke', 'Emission'))):
        colour = re.search(r'^%s (\S+) (\S+) (\S+)' % word, own, re.M)
        colour = [float(x) for x in colour.groups()] if colour else [0, 0, 0]
        most = max(colour + [1e-9]) if word == 'Ke' else 1
        shader, mix = nodes.new('ShaderNode' + kind), nodes.new('ShaderNodeMixRGB')
        mix.inputs['Color1'].default_value = [x / most for x in colour] + [1]
        mix.inputs['Color2'].default_value = 0, 0, 0, 1
        link(back.outputs['Backfacing'], mix.inputs['Fac'])
        link(mix.outputs['Color'], shader.inputs['Color'])
        if word == 'Ke':
            shader.inputs['Strength'].default_value = most / math.pi
        link(shader.outputs[0], both.inputs[k])
    link(both.outputs[0], nodes.new('ShaderNodeOutputMaterial').inputs['Surface'])
eye, at, up = (scale * Vector(view[key]) for key in ('eye', 'at', 'up'))
back = (eye - at).normalized()
right = up.cross(back).normalized()
axes, lens = (right, back.cross(right), back, eye), bpy.data.cameras.new('camera')
lens.sensor_fit = 'VERTICAL'
lens.lens = lens.sensor_height / 2 / math.tan(math.radians(view['fov'][0]) / 2)
lens.clip_start, lens.clip_end = 1e-4 * LENGTH, 100 * LENGTH
camera = scene.camera = bpy.data.objects.new('camera', lens)
camera.matrix_world = Matrix([[a[k] for a in axes] for k in range(3)] + [[0, 0, 0, 1]])
scene.collection.objects.link(camera)
scene.render.resolution_x, scene.render.resolution_y = map(int, view['size'])
scene.render.resolution_percentage, scene.render.engine = 100, 'CYCLES'
bpy.ops.wm.save_as_mainfile(filepath=name + '.blend')
