# A scene of `make corpus` for Mitsuba 3:
#
#   python3 tools/to_mitsuba.py NAME && mitsuba -m scalar_rgb NAME.xml
#
# reads NAME.obj, its .mtl and NAME.view; writes NAME.xml, and NAME-PAINT.ply of each
# material. Ke, a radiosity, becomes the radiance Ke / pi, and the pixels of NAME.exr
# times pi are W/m^2. Backs are black.
import math, os, sys

name, samples = sys.argv[1], 64
rows = lambda path: filter(None, (line.split('#')[0].split() for line in open(path)))
points, faces, materials, view = [], {}, {}, {'up': ['0', '1', '0'], 'fov': ['45']}
view.update((key, rest) for key, *rest in rows(name + '.view'))
for key, *rest in rows(name + '.obj'):
    if key == 'mtllib':
        for word, *value in rows(os.path.join(os.path.dirname(name), rest[0])):
            if word == 'newmtl':
                last = materials[value[0]] = {}
            last[word] = [float(x) for x in value] if word in ('Kd', 'Ke') else value
    elif key == 'v':
        points.append(' '.join(rest[:3]))
    elif key == 'usemtl':
        group = faces.setdefault(rest[0], [])
    elif key == 'f':
        at = [int(word.split('/')[0]) for word in rest]
        at = [n - 1 if n > 0 else len(points) + n for n in at]
        group += [(at[0], at[k], at[k + 1]) for k in range(1, len(at) - 1)]
value = lambda tag, key, x: f'<{tag} name="{key}" value="{x}"/>'
rgb = lambda key, colour: value('rgb', key, ', '.join(map(str, colour)))
look = ' '.join(f'{mine}="{", ".join(view[key])}"' for mine, key in (
    ('origin', 'eye'), ('target', 'at'), ('up', 'up')))
xml = ['<scene version="3.0.0">', '<integrator type="path">',
       value('integer', 'max_depth', 65), '</integrator>', '<sensor type="perspective">',
       value('string', 'fov_axis', 'y'), value('float', 'fov', view['fov'][0]),
       f'<transform name="to_world"><lookat {look}/></transform>',
       '<sampler type="independent">', value('integer', 'sample_count', samples),
       '</sampler>', '<film type="hdrfilm">', value('integer', 'width', view['size'][0]),
       value('integer', 'height', view['size'][1]), '<rfilter type="box"/>',
       value('string', 'pixel_format', 'rgb'),
       value('string', 'component_format', 'float32'), '</film>', '</sensor>']
for paint, group in faces.items():
    own, ply = materials[paint], f'{name}-{paint}.ply'
    used = sorted({n for face in group for n in face})
    place = {n: k for k, n in enumerate(used)}
    head = f'ply\nformat ascii 1.0\nelement vertex {len(used)}\n' + ''.join(
        f'property float {axis}\n' for axis in 'xyz') + f'element face {len(group)}\n'
    with open(ply, 'w') as out:
        print(head + 'property list uchar int vertex_indices\nend_header', file=out)
        print(*(points[n] for n in used), sep='\n', file=out)
        print(*('3 %d %d %d' % tuple(place[n] for n in face) for face in group),
              sep='\n', file=out)
    xml += ['<shape type="ply">', value('string', 'filename', os.path.basename(ply)),
            value('boolean', 'face_normals', 'true'), '<bsdf type="diffuse">',
            rgb('reflectance', own['Kd']), '</bsdf>']
    if max(own.get('Ke', [0])) > 0:
        light = [x / math.pi for x in own['Ke']]
        xml += ['<emitter type="area">', rgb('radiance', light), '</emitter>']
    xml.append('</shape>')
open(name + '.xml', 'w').write('\n'.join(xml + ['</scene>\n']))
