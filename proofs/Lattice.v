(** Bounds of φ, and the one point where a bead rests on two others. That point is differentiable where its
    supports are. *)

From Coq Require Import ZArith Reals Lia Lra.
From ForceDiffusion Require Import Model Sums FirstOrder.

Open Scope R_scope.

Ltac Zify.zify_post_hook ::= Z.div_mod_to_equations.
Ltac same_sites := repeat (f_equal; try lia).

Section Lattice.
  Variable G : lattice.
  Local Notation r := (r G).
  Local Notation n_x := (n_x G).
  Local Notation n_y := (n_y G).

  Lemma r_pos : 0 < r. Proof. apply r_positive. Qed.
  Lemma n_x_pos : 0 < n_x. Proof. pose proof (n_x_above_half G). lra. Qed.
  Lemma n_y_pos : 0 < n_y. Proof. pose proof (n_y_above_half G). lra. Qed.
  Lemma n_y_squared : n_y * n_y = 1 - n_x * n_x.
  Proof. pose proof (unit_vectors G) as H. lra. Qed.

  Lemma phi_is : phi G = n_y * n_y - n_x * n_x.
  Proof. unfold phi, dot, n_plus, n_minus. cbn. ring. Qed.

  Lemma phi_above : - (1 / 2) < phi G.
  Proof.
    rewrite phi_is, n_y_squared. pose proof (n_y_above_half G). pose proof n_y_squared.
    assert (1 / 2 * (1 / 2) < n_y * n_y) by (apply Rmult_gt_0_lt_compat; lra). lra.
  Qed.

  Lemma phi_below : phi G < 1 / 2.
  Proof.
    rewrite phi_is, n_y_squared. pose proof (n_x_above_half G).
    assert (1 / 2 * (1 / 2) < n_x * n_x) by (apply Rmult_gt_0_lt_compat; lra). lra.
  Qed.

  Lemma one_minus_phi_squared : 1 - phi G * phi G = 4 * (n_x * n_x) * (n_y * n_y).
  Proof. rewrite phi_is, n_y_squared. ring. Qed.

  Lemma phi_squared_below : phi G * phi G < 1 / 4.
  Proof.
    pose proof phi_above. pose proof phi_below.
    destruct (Rle_dec 0 (phi G)).
    - assert (phi G * phi G <= phi G * (1 / 2)) by (apply Rmult_le_compat_l; lra). lra.
    - assert (- phi G * - phi G <= - phi G * (1 / 2)) by (apply Rmult_le_compat_l; lra). lra.
  Qed.

  Lemma divisor_positive : 0 < 1 - phi G * phi G.
  Proof. pose proof phi_squared_below. lra. Qed.
End Lattice.

(** ** Where a bead rests on two others *)

(** The point at the distances a and b from A and B, on the left of the way from A to B. *)
Definition meeting (A B : vector) (a b : R) : vector :=
  let d := minus B A in
  let along := (a ^ 2 - b ^ 2 + dot d d) / (2 * dot d d) in
  let across := sqrt (a ^ 2 / dot d d - along ^ 2) in
  Vector (x_of A + (along * x_of d - across * y_of d)) (y_of A + (along * y_of d + across * x_of d)).

Lemma meeting_touches A B a b :
  let d := minus B A in
  0 < dot d d -> 0 <= a ^ 2 / dot d d - ((a ^ 2 - b ^ 2 + dot d d) / (2 * dot d d)) ^ 2 ->
  dot (minus (meeting A B a b) A) (minus (meeting A B a b) A) = a ^ 2 /\
  dot (minus (meeting A B a b) B) (minus (meeting A B a b) B) = b ^ 2.
Proof.
  intros d Hd Hs. unfold meeting. fold d.
  set (s := dot d d) in *. set (t := (a ^ 2 - b ^ 2 + s) / (2 * s)) in *.
  set (h := sqrt (a ^ 2 / s - t ^ 2)).
  assert (Hh : h * h = a ^ 2 / s - t ^ 2) by (apply sqrt_sqrt; exact Hs).
  assert (Es : s = x_of d * x_of d + y_of d * y_of d) by reflexivity.
  assert (Ts : 2 * t * s = a ^ 2 - b ^ 2 + s) by (unfold t; field; lra).
  assert (Hhs : h * h * s = a ^ 2 - t ^ 2 * s) by (rewrite Hh; field; lra).
  unfold dot, minus, add, scale. cbn [x_of y_of]. split.
  - transitivity (t ^ 2 * s + h * h * s); [rewrite Es; ring|]. rewrite Hhs. ring.
  - transitivity (t ^ 2 * s - 2 * t * s + s + h * h * s).
    { rewrite Es. unfold d, minus, add, scale. cbn [x_of y_of]. ring. }
    rewrite Hhs, Ts. ring.
Qed.

(** It is the only one on that side. *)
Lemma meeting_unique A B W a b :
  let d := minus B A in
  0 < dot d d ->
  dot (minus W A) (minus W A) = a ^ 2 -> dot (minus W B) (minus W B) = b ^ 2 ->
  0 < x_of d * y_of (minus W A) - y_of d * x_of (minus W A) -> W = meeting A B a b.
Proof.
  intros d Hd Ha Hb Hc.
  set (s := dot d d) in *. set (u := minus W A) in *.
  assert (Es : s = x_of d * x_of d + y_of d * y_of d) by reflexivity.
  set (c := x_of d * y_of u - y_of d * x_of u) in *.
  assert (Ht : x_of d * x_of u + y_of d * y_of u = (a ^ 2 - b ^ 2 + s) / 2).
  { rewrite <- Ha, <- Hb, Es. unfold u, d, dot, minus, add, scale. cbn [x_of y_of]. field. }
  assert (Hh : sqrt (a ^ 2 / s - ((a ^ 2 - b ^ 2 + s) / (2 * s)) ^ 2) = c / s).
  { replace (a ^ 2 / s - ((a ^ 2 - b ^ 2 + s) / (2 * s)) ^ 2) with (c / s * (c / s)).
    - apply sqrt_square. apply Rlt_le, Rdiv_lt_0_compat; assumption.
    - replace ((a ^ 2 - b ^ 2 + s) / (2 * s)) with ((x_of d * x_of u + y_of d * y_of u) / s)
        by (rewrite Ht; field; lra).
      rewrite <- Ha. unfold c. unfold dot at 1. field_simplify_eq; [rewrite Es; ring|lra]. }
  unfold meeting. fold d. fold s. cbv zeta. rewrite Hh.
  replace ((a ^ 2 - b ^ 2 + s) / (2 * s)) with ((x_of d * x_of u + y_of d * y_of u) / s)
    by (rewrite Ht; field; lra).
  destruct W as [x y]. unfold c, u, minus, add, scale in *. cbn [x_of y_of] in *.
  f_equal; (field_simplify_eq; [rewrite Es; ring|lra]).
Qed.

Section Meeting.
  Variable G : lattice.
  Local Notation r := (r G).
  Local Notation n_x := (n_x G).
  Local Notation n_y := (n_y G).

  (** What the meeting point of two beads of one height needs, and where it is at ε = 0. *)
  Lemma meeting_expands (A B : R -> vector) (a b : R -> R) ax ay ax' ay' bx' by' a' b' :
    expands (fun e => x_of (A e)) ax ax' -> expands (fun e => y_of (A e)) ay ay' ->
    expands (fun e => x_of (B e)) (ax + 4 * r * n_x) bx' -> expands (fun e => y_of (B e)) ay by' ->
    expands a (2 * r) a' -> expands b (2 * r) b' ->
    (exists d, expands (fun e => x_of (meeting (A e) (B e) (a e) (b e))) (ax + 2 * r * n_x) d) /\
    (exists d, expands (fun e => y_of (meeting (A e) (B e) (a e) (b e))) (ay + 2 * r * n_y) d) /\
    near (fun e => 0 < dot (minus (B e) (A e)) (minus (B e) (A e)) /\
      0 < a e ^ 2 / dot (minus (B e) (A e)) (minus (B e) (A e))
        - ((a e ^ 2 - b e ^ 2 + dot (minus (B e) (A e)) (minus (B e) (A e)))
           / (2 * dot (minus (B e) (A e)) (minus (B e) (A e)))) ^ 2).
  Proof.
    intros HAx HAy HBx HBy Ha Hb.
    pose proof (r_pos G) as Hr. pose proof (n_x_pos G) as Hx. pose proof (n_y_pos G) as Hy.
    pose proof (n_y_squared G) as Hn.
    assert (Hrx : 0 < r * n_x) by (apply Rmult_lt_0_compat; assumption).
    assert (Hsq : 0 < (4 * r * n_x) * (4 * r * n_x)) by (apply Rmult_lt_0_compat; lra).
    assert (Dx : exists d, expands (fun e => x_of (minus (B e) (A e))) (4 * r * n_x) d).
    { eexists. unfold minus, add, scale. cbn [x_of y_of].
      eapply expands_to; [apply expands_plus; [exact HBx|apply expands_mult; [apply expands_const|exact HAx]]
        |ring|reflexivity]. }
    assert (Dy : exists d, expands (fun e => y_of (minus (B e) (A e))) 0 d).
    { eexists. unfold minus, add, scale. cbn [x_of y_of].
      eapply expands_to; [apply expands_plus; [exact HBy|apply expands_mult; [apply expands_const|exact HAy]]
        |ring|reflexivity]. }
    destruct Dx as [dx Dx]. destruct Dy as [dy Dy].
    assert (S : exists d, expands (fun e => dot (minus (B e) (A e)) (minus (B e) (A e)))
      ((4 * r * n_x) * (4 * r * n_x)) d).
    { eexists. unfold dot. eapply expands_to; [apply expands_plus; apply expands_mult; eassumption
        |ring|reflexivity]. }
    destruct S as [s' S].
    assert (T : exists d, expands (fun e => (a e ^ 2 - b e ^ 2 + dot (minus (B e) (A e)) (minus (B e) (A e)))
      / (2 * dot (minus (B e) (A e)) (minus (B e) (A e)))) (1 / 2) d).
    { eexists. eapply expands_to; [apply expands_div;
        [|apply expands_plus; [apply expands_minus; apply expands_pow2; eassumption|exact S]
         |apply expands_mult; [apply expands_const|exact S]]; lra|field; lra|reflexivity]. }
    destruct T as [t' T].
    assert (U : exists d, expands (fun e => a e ^ 2 / dot (minus (B e) (A e)) (minus (B e) (A e))
        - ((a e ^ 2 - b e ^ 2 + dot (minus (B e) (A e)) (minus (B e) (A e)))
           / (2 * dot (minus (B e) (A e)) (minus (B e) (A e)))) ^ 2)
      (n_y / (2 * n_x) * (n_y / (2 * n_x))) d).
    { eexists. eapply expands_to; [apply expands_minus;
        [apply expands_div; [|apply expands_pow2; exact Ha|exact S]; lra|apply expands_pow2; exact T]
        |field_simplify_eq; [ring [Hn]|lra]|reflexivity]. }
    destruct U as [u' U].
    assert (Hu : 0 < n_y / (2 * n_x)) by (apply Rdiv_lt_0_compat; lra).
    assert (Huu : 0 < n_y / (2 * n_x) * (n_y / (2 * n_x))) by (apply Rmult_lt_0_compat; assumption).
    assert (V : exists d, expands (fun e => sqrt (a e ^ 2 / dot (minus (B e) (A e)) (minus (B e) (A e))
        - ((a e ^ 2 - b e ^ 2 + dot (minus (B e) (A e)) (minus (B e) (A e)))
           / (2 * dot (minus (B e) (A e)) (minus (B e) (A e)))) ^ 2)) (n_y / (2 * n_x)) d).
    { eexists. eapply expands_to; [apply expands_sqrt; [exact Huu|exact U]
        |apply sqrt_square; lra|reflexivity]. }
    destruct V as [v' V].
    repeat split.
    - eexists. unfold meeting. cbv zeta. cbn [x_of].
      eapply expands_to; [apply expands_plus; [exact HAx|apply expands_minus; apply expands_mult; eassumption]
        |field; lra|reflexivity].
    - eexists. unfold meeting. cbv zeta. cbn [y_of].
      eapply expands_to; [apply expands_plus; [exact HAy|apply expands_plus; apply expands_mult; eassumption]
        |field; lra|reflexivity].
    - apply near_both; eapply expands_near_positive; eassumption.
  Qed.
End Meeting.
