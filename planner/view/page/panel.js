'use strict';

/** Fills the side panel. Names from files are set as text, never as HTML. */
const Panel = {
  fill() {
    byId('name').textContent = data.name;
    const facts = [];
    const models = data.robots.map((robot) => robot.name ? `${robot.name} (${robot.model})` : robot.model);
    facts.push([models.length > 1 ? 'Robots' : 'Robot', models.join(', ')]);
    const s = data.solution, v = data.verdict;
    if (s) {
      const badge = byId('badge');
      badge.textContent = {proved: 'Proved free of contact', refuted: 'Refuted', undecided: 'Undecided', 'other problem': 'Other problem'}[v.verdict];
      badge.textContent += v.except || '';
      badge.className = this.verdictClass();
      if (this.provedOfNothing()) badge.textContent = 'No pair is tested';
      else if (this.exceedsLimits()) badge.textContent += ', limits exceeded';
      badge.hidden = false;
      if (s.planner) facts.push(['Planner', s.planner + (s.seed === undefined ? '' : `, seed ${s.seed}`)]);
      if (s.checker) facts.push(['Certified', s.certified ? 'yes' : `no (${s.checker})`]);
      const length = [s.length_m === null ? '' : metres(s.length_m), s.rotation_rad === null ? '' : `${digits(s.rotation_rad)} rad`];
      if (path.times) facts.push(['Duration', `${digits(path.times[1] - path.times[0])} s`]);
      if (length.some(Boolean)) facts.push(['Path length', length.filter(Boolean).join(', ') + (s.length_of ? ` (${s.length_of})` : '')]);
      if (s.between) facts.push(['Between rows', s.between]);
      facts.push([s.between ? 'Rows' : 'States', s.states.toLocaleString('en')]);
      if (v.verdict !== 'other problem') facts.push(['Edges proved', `${v.edges_proved.toLocaleString('en')} of ${v.edges.toLocaleString('en')}`]);
      if (v.proved_clearance_m !== undefined && v.proved_clearance_m !== null) facts.push(['Proved clearance', `${metres(v.proved_clearance_m)}`]);
      if (v.limits) facts.push(['Limits', v.limits.text]);
    }
    if (s && s.margin_m > 0) facts.push(['Margin', metres(s.margin_m)]);
    facts.push(['Bodies', data.bodies.length.toLocaleString('en')]);
    facts.push(['Triangles', data.bodies.reduce((sum, body) => sum + shapes[body.mesh].triangles, 0).toLocaleString('en')]);
    for (const [key, value] of facts) byId('facts').append(make('dt', key), make('dd', value));
    const notes = [...(s && s.other_files ? ['The path was made for other files than those of this problem' + (v.verdict === 'other problem' ? ', and is not verified.' : '.')] : []), ...data.notes];
    byId('notes').hidden = byId('to-notes').hidden = notes.length === 0;
    byId('to-notes').textContent = notes.length === 1 ? '1 note' : `${notes.length} notes`;
    for (const note of notes) byId('notes').querySelector('ul').append(make('li', note));
    this.pairs();
  },

  bodyName: (index) => index === null ? '' : data.bodies[index].name,

  /** Lists the findings. @param show is called with a finding's index, or -1 for none. */
  findings(show) {
    const v = data.verdict, list = byId('findings').querySelector('ol');
    if (!v || (!v.findings.length && !v.violations.length)) return;
    byId('findings').hidden = false;
    if (v.verdict === 'undecided') byId('findings').querySelector('h2').textContent = 'What could not be proved';
    for (const violation of v.violations) list.append(make('li', violation));
    v.findings.forEach((f, index) => {
      const pair = f.a === null ? '' : `${this.bodyName(f.a)} and ${this.bodyName(f.b)}`;
      const text = make('div', pair ? `${pair}: ${f.reason}` : f.reason,
        make('small', `${f.verdict === 'undecided' ? 'undecided, ' : ''}${f.in_every_state ? 'in every state' : f.time_s === undefined ? `edge ${f.edge}, t = ${digits(f.t)}` : `at ${seconds(f.time_s)}, edge ${f.edge}`}${f.gap_m > 0 ? `, ${metres(f.gap_m)} apart` : ''}`));
      const button = make('button', 'Show');
      button.setAttribute('aria-pressed', 'false');
      button.addEventListener('click', () => show(button.getAttribute('aria-pressed') === 'true' ? -1 : index));
      list.append(make('li', '', text, button));
    });
  },

  /**
   * Returns the index of the finding that a picture shows: the first finding whose verdict is the path's verdict; -1 if
   * there is none.
   */
  mainFinding() {
    return data.verdict ? data.verdict.findings.findIndex((f) => f.verdict === data.verdict.verdict) : -1;
  },

  /** Returns whether the path counts as proved only because no pair is tested. */
  provedOfNothing: () => data.verdict.verdict === 'proved' && data.pairs.tested === 0,

  /** Returns whether a trajectory exceeds the limits over time. */
  exceedsLimits: () => data.verdict.limits !== undefined && data.verdict.limits.verdict === 'exceeded',

  /**
   * Returns the CSS class of the verdict. Only a proof is green, and only if pairs were tested and no limit is
   * exceeded.
   */
  verdictClass() {
    const {verdict} = data.verdict, weaker = this.provedOfNothing() || (verdict === 'proved' && this.exceedsLimits());
    return weaker || verdict === 'other problem' ? 'undecided' : verdict;
  },

  /** Returns the verdict in one line, such as "refuted: seat and shelf touch". */
  verdictText() {
    if (this.provedOfNothing()) return 'no pair is tested';
    const {verdict, findings, violations} = data.verdict, f = findings[this.mainFinding()];
    const short = (name) => name.length > 32 ? `${name.slice(0, 15)}…${name.slice(-16)}` : name;  // to fit into a picture's legend
    const pair = f && f.a !== null ? `${short(this.bodyName(f.a))} and ${short(this.bodyName(f.b))}` : '';
    const reason = !f ? (violations[0] || '').split(': ')[0] : !pair ? f.reason : f.reason === 'contact' ? `${pair} touch` : `${pair}: ${f.reason}`;
    const always = f && f.in_every_state ? ' in every state' : '';
    return reason ? `${verdict}: ${reason}${always}` : verdict + (data.verdict.except || '');
  },

  pressFinding(index) {
    byId('findings').querySelectorAll('button').forEach((button, i) => button.setAttribute('aria-pressed', String(i === index)));
  },

  pairs() {
    const body = byId('pairs-body'), {tested, skipped} = data.pairs, far = data.array(data.pairs.far), atRest = data.array(data.pairs.at_rest);
    const numberOf = (array) => array.length / 2;
    const sum = skipped.reduce((total, group) => total + group.pairs[2] / 2, 0);
    body.append(make('p', `${counted(tested, 'pair')} of bodies tested, ${sum.toLocaleString('en')} not. Obstacles are never tested with each other, nor a body with itself.`));
    const group = (title, array) => {
      const details = make('details', '', make('summary', `${title}: ${numberOf(array).toLocaleString('en')}`)), list = make('ul');
      details.append(list);
      details.addEventListener('toggle', () => {  // lists of thousands of pairs are made only when they are opened
        if (list.children.length) return;
        for (let i = 0; i < array.length && i < 1000; i += 2) list.append(make('li', `${this.bodyName(array[i])} ~ ${this.bodyName(array[i + 1])}`));
        if (array.length > 1000) list.append(make('li', `and ${(numberOf(array) - 500).toLocaleString('en')} more`));
      });
      body.append(details);
    };
    for (const {reason, pairs} of skipped) group(reason, data.array(pairs));
    if (atRest.length) group('tested once, because only held joints are between the two', atRest);
    if (far.length) group('tested, but out of reach', far);
  },

  legend(stage) {
    const item = (className, colour, text) => {
      const swatch = make('i');
      swatch.className = className;
      if (colour) swatch.style.background = colour;
      return make('span', '', swatch, document.createTextNode(text));
    };
    const legend = byId('legend');
    const image = document.body.classList.contains('image');
    const end = path && !data.verdict.reaches_goal ? 'end of the path, not in the goal' : 'goal';
    legend.replaceChildren(item('', palette.start, 'start'),
      item('', palette.goal, path ? end : data.goal_count > 1 ? `goals (${data.goals.length} of ${data.goal_count})` : 'goal'));
    if (path) legend.append(item('way', '', 'between'));
    const names = data.robots.length > 1 ? data.robots.map((robot) => `${robot.name}, now`) : ['now'];
    if (path && !image) names.forEach((text, i) => legend.append(item('', palette.robots[i % palette.robots.length], text)));
    legend.append(item('scale', '', `grid ${metres(stage.step)}`));
    if (!path || !image) return;
    if (path.times) legend.append(make('span', `duration ${digits(path.times[1] - path.times[0])} s`));
    // Pictures have no panel, so their legend states the verdict. A mark in the legend stands for the ring in the
    // scene.
    const finding = data.verdict.findings[this.mainFinding()], said = make('span', this.verdictText());
    said.className = `verdict ${this.verdictClass()}`;
    if (finding && finding.a !== null) said.prepend(make('i'));
    legend.append(said);
  },

  /** Shows the position on the path, or the time of a trajectory, and the closest pair there. */
  place(at, closest) {
    const i = lastNotAbove(path.at, at), k = Math.min(i + 1, path.at.length - 1);
    const u = path.at[k] > path.at[i] ? (at - path.at[i]) / (path.at[k] - path.at[i]) : 0;
    const from = path.edge[k] === path.edge[i] && i > 0 ? path.t[i] : 0, t = k > i ? from + u * (path.t[k] - from) : path.t[i];
    byId('place').textContent = path.times ? `${seconds(timeAt(at))}, edge ${path.edge[k]}` : path.states.length > 1 ? `edge ${path.edge[k]}, t = ${t.toFixed(3)}` : 'a single state';
    byId('slider').setAttribute('aria-valuetext', byId('place').textContent);
    if (!closest) return;
    const n = closest.indexAt(at), d = closest.metres[n];
    byId('closest-text').replaceChildren(make('b', d > 0 ? metres(d) : 'contact'),
      document.createTextNode(`: ${this.bodyName(closest.bodies[2 * n])} and ${this.bodyName(closest.bodies[2 * n + 1])}`));
  },
};
