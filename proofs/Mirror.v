(** The mirror image of a packing at a vertical line is a packing, and that of its forces balances the mirror image
    of the load. So what is proved of n⁺ and f⁺ holds of n⁻ and f⁻. *)

From Coq Require Import ZArith Reals Lia Lra.
From ForceDiffusion Require Import Model Sums FirstOrder Lattice Geometry.

Open Scope R_scope.
Ltac Zify.zify_post_hook ::= Z.div_mod_to_equations.

Definition flipped (v : vector) : vector := Vector (- x_of v) (y_of v).
Definition mirrored_centres (X : centres) : centres := mirrored (fun i j e => flipped (X i j e)).
Definition mirrored_forces (F : forces) : forces := Forces (mirrored (f_minus F)) (mirrored (f_plus F)).

Lemma mirrored_back (rho : radii) : mirrored (mirrored rho) = rho.
Proof.
  apply FunctionalExtensionality.functional_extensionality. intros i.
  unfold mirrored. rewrite Z.opp_involutive. reflexivity.
Qed.

Lemma flipped_downwards g : flipped (downwards g) = downwards g.
Proof. unfold flipped, downwards. cbn. f_equal. ring. Qed.

Lemma flipped_distance u v : dot (minus (flipped u) (flipped v)) (minus (flipped u) (flipped v)) =
  dot (minus u v) (minus u v).
Proof. unfold dot, minus, add, scale, flipped. cbn [x_of y_of]. ring. Qed.

Lemma direction_flipped u v : direction (flipped u) (flipped v) = flipped (direction u v).
Proof.
  unfold direction, norm. rewrite flipped_distance.
  unfold minus, add, scale, flipped. cbn [x_of y_of]. f_equal; ring.
Qed.

Lemma N_plus_mirrored X i j e : N_plus (mirrored_centres X) (- i) j e = flipped (N_minus X i j e).
Proof.
  unfold N_plus, N_minus. rewrite <- direction_flipped. unfold mirrored_centres, mirrored.
  f_equal; f_equal; f_equal; lia.
Qed.

Lemma N_minus_mirrored X i j e : N_minus (mirrored_centres X) (- i) j e = flipped (N_plus X i j e).
Proof.
  unfold N_plus, N_minus. rewrite <- direction_flipped. unfold mirrored_centres, mirrored.
  f_equal; f_equal; f_equal; lia.
Qed.

Section Packing.
  Context (G : lattice) (M : Z) (rho : radii) (X : centres) (P : packing G M rho X).

  Theorem mirrored_packing : packing G M (mirrored rho) (mirrored_centres X).
  Proof.
    assert (N : forall i j, bead M i j -> bead M (- i) j) by (intros; site).
    split; intros i j; unfold mirrored_centres, mirrored.
    - intros H. rewrite (base_is_fixed _ _ _ _ P) by site. unfold flipped. cbn [x_of y_of].
      rewrite opp_IZR. f_equal. ring.
    - intros H. destruct (continuous _ _ _ _ P (- i) j (N i j H)) as [Cx Cy].
      split; [apply continuity_pt_opp; exact Cx|exact Cy].
    - intros H Hj. pose proof (touches_right _ _ _ _ P (- i) j (N i j H) Hj) as T.
      replace (- i + 1)%Z with (- (i - 1))%Z in T by lia.
      eapply near_then; [exact T|]. intros e E. rewrite flipped_distance. exact E.
    - intros H Hj. pose proof (touches_left _ _ _ _ P (- i) j (N i j H) Hj) as T.
      replace (- i - 1)%Z with (- (i + 1))%Z in T by lia.
      eapply near_then; [exact T|]. intros e E. rewrite flipped_distance. exact E.
    - intros H Hj. unfold flipped. cbn [y_of].
      rewrite !(ordered_position G M rho X P) by site. cbn [y_of].
      pose proof (r_pos G). pose proof (n_y_pos G). rewrite minus_IZR.
      assert (0 < r G * n_y G) by (apply Rmult_lt_0_compat; lra). lra.
  Qed.

  Theorem mirrored_carries load load' F : carries M X load F ->
    (forall i j, load' i j = flipped (load (- i)%Z j)) ->
    carries M (mirrored_centres X) load' (mirrored_forces F).
  Proof.
    intros C L. split.
    - intros i e. destruct (free_surface _ _ _ _ C (- i)%Z e). auto.
    - intros i j H Hj. pose proof (balance _ _ _ _ C (- i)%Z j ltac:(site) Hj) as B.
      eapply near_then; [exact B|]. intros e E. unfold balanced in *. rewrite L.
      pose proof (N_plus_mirrored X) as A. pose proof (N_minus_mirrored X) as D.
      specialize (A (- (i - 1))%Z (j - 1)%Z e) as A1. specialize (A (- i)%Z j e).
      specialize (D (- (i + 1))%Z (j - 1)%Z e) as D1. specialize (D (- i)%Z j e).
      rewrite !Z.opp_involutive in *. rewrite A, A1, D, D1. unfold mirrored_forces, mirrored.
      cbn [f_plus f_minus]. replace (- (i - 1))%Z with (- i + 1)%Z by lia.
      replace (- (i + 1))%Z with (- i - 1)%Z by lia.
      pose proof (f_equal x_of E) as Ex. pose proof (f_equal y_of E) as Ey.
      components in Ex. components in Ey. unfold flipped, minus, add, scale, zero. components.
      f_equal; lra.
  Qed.
End Packing.

Lemma f_minus_is F i j : f_minus F i j = f_plus (mirrored_forces F) (- i) j.
Proof. cbn. unfold mirrored. rewrite Z.opp_involutive. reflexivity. Qed.

(** n⁺·δn⁻ to first order, over ε. *)
Definition tilt_minus (G : lattice) (rho : radii) (i j : Z) : R := tilt_plus G (mirrored rho) (- i) j.

Lemma tilt_plus_mirrored G rho i j : tilt_plus G (mirrored rho) i j = tilt_minus G rho (- i) j.
Proof. unfold tilt_minus. rewrite Z.opp_involutive. reflexivity. Qed.
Lemma tilt_minus_mirrored G rho i j : tilt_minus G (mirrored rho) i j = tilt_plus G rho (- i) j.
Proof. unfold tilt_minus. rewrite mirrored_back. reflexivity. Qed.

Lemma tilt_minus_is G rho i j : (0 <= j)%Z ->
  2 * r G * tilt_minus G rho i j =
  (1 - phi G) * (rho i j + rho (i - 1)%Z (j + 1)%Z) + (rho (i - j - 2)%Z 0%Z - rho (i - j)%Z 0%Z
    + 2 * (Sum 1 j (fun m => rho (i - j + m - 2)%Z m) - Sum 1 j (fun m => rho (i - j + m)%Z m))).
Proof.
  intros Hj. unfold tilt_minus. rewrite tilt_plus_is by exact Hj. unfold mirrored.
  normal_form. ring.
Qed.

Section Directions.
  Context (G : lattice) (M : Z) (rho : radii) (X : centres) (P : packing G M rho X).
  Local Notation n_x := (n_x G).
  Local Notation n_y := (n_y G).

  Lemma N_minus_expands i j : contact M i j ->
    expands (fun e => x_of (N_minus X i j e)) (- n_x) (tilt_minus G rho i j / (2 * n_x)) /\
    expands (fun e => y_of (N_minus X i j e)) n_y (tilt_minus G rho i j / (2 * n_y)).
  Proof.
    intros H. pose proof (n_x_pos G). pose proof (n_y_pos G).
    destruct (N_plus_expands G M _ _ (mirrored_packing G M rho X P) (- i) j ltac:(site)) as [Ex Ey].
    split; (eapply expands_near; [eapply expands_to|]).
    - apply expands_opp. exact Ex.
    - reflexivity.
    - unfold tilt_minus. field. lra.
    - apply near_always. intros e. rewrite N_plus_mirrored. unfold flipped. cbn [x_of]. ring.
    - exact Ey.
    - reflexivity.
    - reflexivity.
    - apply near_always. intros e. rewrite N_plus_mirrored. reflexivity.
  Qed.

  Lemma delta_n_minus_expands i j : contact M i j ->
    expands (fun e => x_of (delta_n_minus G X i j e)) 0 (tilt_minus G rho i j / (2 * n_x)) /\
    expands (fun e => y_of (delta_n_minus G X i j e)) 0 (tilt_minus G rho i j / (2 * n_y)).
  Proof.
    intros H. destruct (N_minus_expands i j H). unfold delta_n_minus, n_minus, minus, add, scale. cbn [x_of y_of].
    split; (eapply expands_to; [apply expands_plus; [eassumption|apply expands_const]|ring|ring]).
  Qed.
End Directions.
