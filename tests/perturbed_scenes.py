#!/usr/bin/env python3
"""Makes scene files with seeded errors from truth files, to compare two programs that judge them.

usage: tests/perturbed_scenes.py OUT_DIR SEED [GT.jsonl ...]

Writes OUT_DIR/scenes_K.jsonl for the K-th truth, and single images with truth of their own: balls.json, samples.yaml,
poses.csv, images.jsonl (one line an image) and draws.jsonl (several). Every way of being wrong that the judgement knows occurs: lines that miss, values that are null,
doubled and false objects, swapped teams, covariances that are none, poses marked `mirror`, sectors of all states.
"""
import json
import math
import pathlib
import random
import sys


class Perturbed:
    def __init__(self, seed):
        self.random = random.Random(seed)

    def chance(self, probability):
        return self.random.random() < probability

    def near(self, value, sigma):
        return value + self.random.gauss(0, sigma)

    def maybe(self, value, probability=.9):
        return value if self.chance(probability) else None

    def covariance(self, size, sigma):
        """Row-major, mostly positive definite."""
        if self.chance(.08):
            return [-1e-4 if i % (size + 1) == 0 else 0 for i in range(size * size)]
        columns = [[self.random.gauss(0, sigma) for _ in range(size + 2)] for _ in range(size)]
        return [sum(a * b for a, b in zip(p, q)) for p in columns for q in columns]

    def box(self, seen, sigma):
        """A box with exclusive ends near the true one."""
        box = seen['bbox'] or seen['bbox_full']
        return [self.near(b, sigma) + (i > 1) for i, b in enumerate(box)] if box else self.any_box()

    def any_box(self):
        x, y = self.random.uniform(0, 300), self.random.uniform(0, 150)
        return [x, y, x + self.random.uniform(2, 40), y + self.random.uniform(2, 30)]

    def floor(self, x, y, sigma):
        x, y = self.near(x, sigma), self.near(y, sigma)
        distance = math.hypot(x, y)
        near, far = distance - abs(self.random.gauss(0, 2 * sigma)), distance + abs(self.random.gauss(0, 2 * sigma))
        out = {'x': x, 'y': y, 'distance': distance + (.5 if self.chance(.05) else 0), 'near': near, 'far': far}
        for key in ('near', 'far', 'distance'):
            out[key] = self.maybe(out[key], .95)
        return {**out, 'x': None, 'y': None} if self.chance(.06) else out

    def pose(self, truth):
        if self.chance(.15):
            return None
        x, y, theta = truth['x'], truth['y'], truth['theta']
        mirrored = self.chance(.2)
        if mirrored:
            x, y, theta = -x, -y, theta + math.pi
        sigma = self.random.choice([.02, .05, .4])
        return {'x': self.near(x, sigma), 'y': self.near(y, sigma), 'theta': self.near(theta, sigma / 2),
                'cov': self.covariance(3, sigma), 'mirror': mirrored or self.chance(.1),
                'kind': self.random.choice(['two_lines', 'one_line', 'predicted', 'goal', 'model', 'start'])}

    def balls(self, truth):
        out = []
        if truth['bbox'] and self.chance(.85):
            sigma = .03 * truth['dist']
            for _ in range(2 if self.chance(.15) else 1):
                out.append({**self.floor(truth['rx'], truth['ry'], sigma), 'box': self.box(truth, 1.5),
                            'cov': self.maybe(self.covariance(2, sigma), .95)})
        for _ in range(self.random.choice([0, 0, 0, 1, 2])):
            out.append({**self.floor(2, 1, 1), 'box': self.any_box(), 'cov': self.covariance(2, .2)})
        if self.chance(.15):
            self.random.shuffle(out)
        return out

    def goals(self, truth):
        out = []
        for color, goal in truth.items():
            for _ in range(2 if self.chance(.1) else 1):
                if (goal['bbox'] and self.chance(.9)) or self.chance(.05):
                    bearing = self.near(math.atan2(goal['ry'], goal['rx']), .02)
                    out.append({'color': color, 'box': self.box(goal, 4), 'bearing': self.maybe(bearing)})
        return out

    def robots(self, truth):
        out = []
        for robot in truth:
            if (robot['bbox'] and self.chance(.85)) or self.chance(.05):
                away = math.hypot(robot['rx'], robot['ry'])
                nearer = max(0, 1 - .2 / away)
                team = self.random.choice([robot['team_color']] * 6 + ['cyan', 'magenta', 'unknown'])
                center = [self.near(robot['rx'], .1), self.near(robot['ry'], .1)]
                out.append({**self.floor(nearer * robot['rx'], nearer * robot['ry'], .1), 'team': team, 'box': self.box(robot, 3),
                            **({} if self.chance(.1) else {'center': self.maybe(center)})})
        self.random.shuffle(out)
        return out

    def free_space(self, truth):
        if self.chance(.08):
            return None
        camera = truth['free']['camera']
        count = self.random.choice([0, 36, 60, 72, 90])
        step = 2 * math.pi / 72
        first = self.random.uniform(-math.pi, math.pi / 2)
        ranges, states = [], []
        for i in range(count):
            state = self.random.choice(['blocked', 'blocked', 'blocked', 'free', 'unseen'])
            ray = camera['ray'][round((first + i * step) / math.radians(10)) % 36] or 3
            ranges.append(None if state == 'unseen' else max(0, ray * self.random.uniform(.75, 1.1)))
            states.append(state)
        origin = camera['origin'] if self.chance(.7) else [self.near(0, .05), self.near(0, .05)]
        return {'origin': origin, 'angle_min': first, 'angle_increment': step, 'ranges': ranges, 'state': states}

    def timing(self):
        stages = ['decode', 'segment', 'detect', 'localize'] + (['warm_up'] if self.chance(.3) else [])
        out = {stage: self.random.uniform(.1, 1) for stage in stages}
        return {**out, 'total': sum(out.values())}

    def scene(self, truth):
        scene = {'frame': truth['frame'], 't': truth['t'] + (.02 if self.chance(.05) else .001), 'pose': self.pose(truth['robot']),
                 'balls': self.balls(truth['ball']), 'goals': self.goals(truth['goals']), 'robots': self.robots(truth['robots']),
                 'free_space': self.free_space(truth), 'timing_ms': self.timing()}
        return scene if self.chance(.1) else {**scene, 'lines': [], 'why': {}}

    def scenes(self, truth):
        lines = [self.scene(frame) for frame in truth if not self.chance(.07)]
        if self.chance(.3):
            for line in lines:
                line['pose'] = None
        self.random.shuffle(lines)
        return lines

    def single_images(self, count):
        """(balls.json, samples.yaml, poses.csv, one scene line an image, several)"""
        images, samples, poses, lines, draws = [], [], ['image,x,y,theta,quality,note'], [], []
        for k in range(count):
            name = f'image_{k:02}.png'
            balls = [{'box': [round(b) for b in self.any_box()]} for _ in range(self.random.choice([0, 1, 1, 2]))]
            ignore = [self.any_box() for _ in range(self.random.choice([0, 0, 1]))]
            images.append({'image': name, 'balls': balls, 'ignore': ignore})
            if self.chance(.1):
                samples.append(f'- {{image: images/{name}, class: red, rectangle: [1, 2, 9, 9]}}')
            pose = {'x': self.random.uniform(-3, 3), 'y': self.random.uniform(-2, 2), 'theta': self.random.uniform(-3, 3)}
            quality = self.random.choice(['good', 'poor', 'static', 'other'])
            poses.append(f'images/{name},{pose["x"]},{pose["y"]},{pose["theta"]},{quality},by hand')
            if self.chance(.1):
                continue
            found = [[self.near(b, 1.5) for b in box] for box in [b['box'] for b in balls] + ignore if self.chance(.9)]
            found += [self.any_box() for _ in range(self.random.choice([0, 0, 1]))]
            self.random.shuffle(found)
            lines.append({'frame': k, 't': k, 'image': f'images/{name}', 'pose': self.pose(pose),
                          'balls': [{**self.floor(1, 1, .1), 'box': box, 'cov': None} for box in found],
                          'goals': [], 'robots': [], 'free_space': None, 'lines': [], 'why': {}, 'timing_ms': {'total': 1}})
            draws += [{**lines[-1], 'pose': self.pose(pose)} for _ in range(self.random.choice([1, 3]))]
        lines.append({**lines[0], 'frame': count, 'image': 'unknown.png'})
        return {'images': images}, samples, poses, lines, draws


def write_lines(path, records):
    path.write_text(''.join(json.dumps(record) + '\n' for record in records), encoding='utf-8')


def main():
    out, seed = pathlib.Path(sys.argv[1]), int(sys.argv[2])
    for k, path in enumerate(sys.argv[3:]):
        with open(path, encoding='utf-8') as f:
            truth = [json.loads(line) for line in f]
        write_lines(out / f'scenes_{k}.jsonl', Perturbed(seed + k).scenes(truth))
    balls, samples, poses, lines, draws = Perturbed(seed).single_images(60)
    (out / 'balls.json').write_text(json.dumps(balls), encoding='utf-8')
    (out / 'samples.yaml').write_text('\n'.join(samples) + '\n', encoding='utf-8')
    (out / 'poses.csv').write_text('\n'.join(poses) + '\n', encoding='utf-8')
    write_lines(out / 'images.jsonl', lines)
    write_lines(out / 'draws.jsonl', draws)


if __name__ == '__main__':
    main()
